#pragma once

#include <deque>
#include <memory>
#include <mutex>
#include <vector>

#include "cluster/messenger.h"

namespace catoptric::test {

/// Messages between threads that stand for processes.
class Mailboxes {
 public:
  explicit Mailboxes(int size) : boxes_(static_cast<std::size_t>(size)) {}

  std::unique_ptr<cluster::Messenger> of(int rank) { return std::make_unique<Box>(*this, rank); }

 private:
  class Box : public cluster::Messenger {
   public:
    Box(Mailboxes& all, int rank) : all_(all), rank_(rank) {}
    int rank() const override { return rank_; }
    int size() const override { return static_cast<int>(all_.boxes_.size()); }
    int size_here() const override { return size(); }
    void send(int to, cluster::Topic topic, const Bytes& bytes) override {
      const std::scoped_lock lock(all_.mutex_);
      all_.boxes_[static_cast<std::size_t>(to)].push_back({rank_, topic, bytes});
    }
    std::optional<cluster::Message> look() override {
      const std::scoped_lock lock(all_.mutex_);
      auto& box = all_.boxes_[static_cast<std::size_t>(rank_)];
      if (box.empty()) return std::nullopt;
      cluster::Message message = std::move(box.front());
      box.pop_front();
      return message;
    }
    void abort(int) override {}

   private:
    Mailboxes& all_;
    int rank_;
  };

  std::mutex mutex_;
  std::vector<std::deque<cluster::Message>> boxes_;
};

}  // namespace catoptric::test
