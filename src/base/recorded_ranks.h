#pragma once

#include <vector>

#include "base/ranks.h"

namespace catoptric {

/// What the joins of a piece of work gave, in order. The work is a function of these and its input, so that
/// another process can repeat it from them without computing a task.
using JoinLog = std::vector<Bytes>;

/// A process by itself that keeps what its joins give. The last entry is an error where one ended the work.
class RecordingRanks : public Ranks {
 public:
  bool is_alone() const override { return inside_; }
  Bytes join(std::size_t count, const Compute& compute, const Take& take, const Joined& joined) override;
  const JoinLog& log() const { return log_; }

 private:
  JoinLog log_;
  bool inside_ = false;
};

/// Answers joins from a log.
/// @fails in a join, std::runtime_error where the log has no such entry: the work is not the one recorded
class RepeatingRanks : public Ranks {
 public:
  explicit RepeatingRanks(JoinLog log) : log_(std::move(log)) {}
  bool is_alone() const override { return false; }
  Bytes join(std::size_t count, const Compute& compute, const Take& take, const Joined& joined) override;

 private:
  JoinLog log_;
  std::size_t at_ = 0;
};

}  // namespace catoptric
