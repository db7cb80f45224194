#include "cluster/shared_ranks.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <mutex>
#include <thread>

#include "base/byte_record.h"
#include "base/errors.h"
#include "base/task_result.h"

namespace catoptric::cluster {
namespace {

constexpr std::uint64_t no_task = ~std::uint64_t{0};
constexpr int our_bug = 1;
/// For others to end what they are at once rank 0 has failed.
constexpr std::chrono::seconds longest_farewell{5};

/// Sleeps a little longer each time nothing has come, so that a rank that waits takes no core from one that
/// works.
class Patience {
 public:
  void sleep() {
    std::this_thread::sleep_for(pause_);
    pause_ = std::min(2 * pause_, longest);
  }
  void reset() { pause_ = shortest; }

 private:
  static constexpr std::chrono::microseconds shortest{10}, longest{1000};
  std::chrono::microseconds pause_ = shortest;
};

/// True while it lives.
class Inside {
 public:
  explicit Inside(bool& flag) : flag_(flag) { flag_ = true; }
  ~Inside() { flag_ = false; }

 private:
  bool& flag_;
};

/// A rank asks for a task and brings what it has.
struct Request {
  std::uint64_t join = 0, done = no_task;
  Bytes result;

  Bytes bytes() const { return ByteWriter().put(join).put(done).put(result).take(); }
  static Request of(const Bytes& bytes) {
    Request request;
    ByteReader(bytes).get(request.join).get(request.done).get(request.result);
    return request;
  }
};

struct Farewell {
  int exit_code = 0;
  std::string words;

  Bytes bytes() const { return ByteWriter().put(exit_code).put(words).take(); }
  static Farewell of(const Bytes& bytes) {
    Farewell farewell;
    ByteReader(bytes).get(farewell.exit_code).get(farewell.words);
    return farewell;
  }
};

std::string words_of(int rank, const Farewell& farewell) {
  return fmt::format(
      "rank {} ended before the others: {}", rank,
      farewell.words.empty() ? fmt::format("exit code {}", farewell.exit_code) : farewell.words);
}

void print_error(const std::string& words) { fmt::print(stderr, "catoptric: {}\n", words); }

}  // namespace

/// Rank 0's part of one join: what has been handed out and what has come back. A thread answers the others.
class SharedRanks::Leader {
 public:
  Leader(SharedRanks& ranks, std::size_t count)
      : ranks_(ranks), count_(count), answering_([this] { answer(); }) {}

  /// Computes and takes until all results are taken, or one failed; the others have then been told.
  void run(const Compute& compute, const Take& take) {
    try {
      take_all(compute, take);
    } catch (...) {
      {
        const std::scoped_lock lock(mutex_);
        failed_ = 0;
        next_ = count_;
      }
      answering_.join();
      throw;
    }
    answering_.join();
  }

 private:
  void take_all(const Compute& compute, const Take& take) {
    std::unique_lock lock(mutex_);
    while (taken_ < end()) {
      if (const auto ready = results_.find(taken_); ready != results_.end()) {
        Bytes result = std::move(ready->second);
        results_.erase(ready);
        const std::size_t task = taken_++;
        lock.unlock();
        take(task, result_of(std::move(result)));
        lock.lock();
      } else if (const std::uint64_t task = assign(); task != no_task) {
        lock.unlock();
        Bytes result = result_or_error([&] { return compute(task); });
        lock.lock();
        keep(task, std::move(result));
      } else {
        arrived_.wait(lock);
      }
    }
  }

  /// Tasks whose results are wanted: all, or those up to the first that failed.
  std::size_t end() const { return std::min(count_, failed_ + 1); }

  std::uint64_t assign() { return next_ < end() ? next_++ : no_task; }

  void keep(std::size_t task, Bytes result) {
    if (is_error(result)) failed_ = std::min(failed_, task);
    results_[task] = std::move(result);
    arrived_.notify_one();
  }

  /// Until every other rank has been told that there is no more.
  void answer() {
    Patience patience;
    for (int waiting = ranks_.size() - 1; waiting > 0;) {
      const auto message = ranks_.messenger_->look();
      if (!message) {
        patience.sleep();
        continue;
      }
      patience.reset();
      ranks_.end_if_farewell(*message);
      Request request = Request::of(message->bytes);
      ranks_.require_here(message->from, request.join);
      std::uint64_t task = no_task;
      {
        const std::scoped_lock lock(mutex_);
        if (request.done != no_task) keep(request.done, std::move(request.result));
        task = assign();
      }
      if (task == no_task) --waiting;
      ranks_.messenger_->send(message->from, Topic::assignment, ByteWriter().put(task).take());
    }
  }

  SharedRanks& ranks_;
  const std::size_t count_;
  std::mutex mutex_;  // of all below
  std::condition_variable arrived_;
  std::size_t next_ = 0, taken_ = 0;
  std::size_t failed_ = static_cast<std::size_t>(-2);  ///< first task that failed
  std::map<std::size_t, Bytes> results_;               ///< that are not taken yet
  std::jthread answering_;
};

SharedRanks::SharedRanks(std::unique_ptr<Messenger> messenger) : messenger_(std::move(messenger)) {}
SharedRanks::~SharedRanks() = default;

int SharedRanks::rank() const { return messenger_->rank(); }
int SharedRanks::size() const { return messenger_->size(); }
int SharedRanks::size_here() const { return messenger_->size_here(); }

Bytes SharedRanks::join(std::size_t count, const Compute& compute, const Take& take, const Joined& joined) {
  if (inside_ || size() == 1) return Ranks::join(count, compute, take, joined);
  if (released_) throw Interrupted();
  ++joins_;
  if (!leads()) return follow(count, compute);
  Bytes result = result_or_error([&] { return lead(count, compute, take, joined); });
  tell_all(result);
  return result_of(std::move(result));
}

std::vector<Bytes> SharedRanks::each(const ComputeOwn& compute) {
  if (inside_ || size() == 1) return Ranks::each(compute);
  if (released_) throw Interrupted();
  ++joins_;
  Bytes own = result_or_error([&] {
    const Inside task_runs(inside_);
    return compute(static_cast<std::size_t>(rank()), static_cast<std::size_t>(size()));
  });
  Bytes all;
  if (leads()) {
    all = result_or_error([&] { return ByteWriter().put(gather(std::move(own))).take(); });
    tell_all(all);
  } else {
    messenger_->send(0, Topic::request,
                     Request{joins_, static_cast<std::uint64_t>(rank()), std::move(own)}.bytes());
    all = from_leader().bytes;
  }
  all = result_of(std::move(all));
  return ByteReader(all).get<std::vector<Bytes>>();
}

/// Rank 0's result and what the others send.
std::vector<Bytes> SharedRanks::gather(Bytes own) {
  std::vector<Bytes> kept(static_cast<std::size_t>(size()));
  kept[0] = std::move(own);
  for (int missing = size() - 1; missing > 0; --missing) {
    const Message message = wait();
    end_if_farewell(message);
    Request request = Request::of(message.bytes);
    require_here(message.from, request.join);
    kept[static_cast<std::size_t>(message.from)] = std::move(request.result);
  }
  for (Bytes& each : kept) each = result_of(std::move(each));
  return kept;
}

void SharedRanks::end_if_farewell(const Message& message) {
  if (message.topic != Topic::farewell) return;
  const Farewell farewell = Farewell::of(message.bytes);
  end_all(farewell.exit_code > 0 ? farewell.exit_code : our_bug, words_of(message.from, farewell));
}

/// That a rank is at the same call as rank 0.
void SharedRanks::require_here(int from, std::uint64_t join) {
  if (join != joins_)
    end_all(our_bug, fmt::format("a mistake of this program, please report it: rank {} is at join {}, rank 0 "
                                 "at {}",
                                 from, join, joins_));
}

void SharedRanks::tell_all(const Bytes& joined) {
  for (int to = 1; to < size(); ++to) messenger_->send(to, Topic::joined, joined);
}

Bytes SharedRanks::lead(std::size_t count, const Compute& compute, const Take& take, const Joined& joined) {
  const auto inside = [&](std::size_t task) {
    const Inside task_runs(inside_);
    return compute(task);
  };
  if (count == 1)
    take(0, inside(0));
  else if (count > 1)
    Leader(*this, count).run(inside, take);
  return joined();
}

Bytes SharedRanks::follow(std::size_t count, const Compute& compute) {
  Request request{joins_, no_task, {}};
  while (count > 1) {
    messenger_->send(0, Topic::request, request.bytes());
    const auto task = ByteReader(from_leader().bytes).get<std::uint64_t>();
    if (task == no_task) break;
    request.done = task;
    const Inside task_runs(inside_);
    request.result = result_or_error([&] { return compute(task); });
  }
  return result_of(from_leader().bytes);
}

Message SharedRanks::from_leader() {
  Message message = wait();
  if (message.topic != Topic::release) return message;
  released_ = true;
  throw Interrupted();
}

Message SharedRanks::wait() {
  for (Patience patience;; patience.sleep())
    if (auto message = messenger_->look()) return std::move(*message);
}

int SharedRanks::leave(int exit_code, const std::string& words) {
  if (size() == 1) return exit_code;
  if (leads()) return release_all(exit_code);
  messenger_->send(0, Topic::farewell, Farewell{exit_code, words}.bytes());
  while (!released_) released_ = wait().topic == Topic::release;
  return 0;
}

int SharedRanks::release_all(int exit_code) {
  const bool failed = exit_code != 0;
  const auto release = [&] {
    for (int to = 1; to < size(); ++to) messenger_->send(to, Topic::release, {});
  };
  if (failed) release();  // who waits for work need not
  std::map<int, Farewell> gone;
  const auto begin = std::chrono::steady_clock::now();
  for (Patience patience; static_cast<int>(gone.size()) < size() - 1;) {
    const auto message = messenger_->look();
    if (message && message->topic == Topic::farewell) {
      gone[message->from] = Farewell::of(message->bytes);
    } else if (message && !failed) {
      end_all(our_bug,
              fmt::format("a mistake of this program, please report it: rank {} still waits for work",
                          message->from));
    } else {
      if (failed && std::chrono::steady_clock::now() - begin > longest_farewell)
        end_all(exit_code, "other ranks are still at work after the error above: they are ended");
      patience.sleep();
    }
  }
  if (failed) return exit_code;
  release();
  for (const auto& [rank, farewell] : gone) {
    if (farewell.exit_code == 0) continue;
    print_error(words_of(rank, farewell));
    return farewell.exit_code;
  }
  return exit_code;
}

void SharedRanks::end_all(int exit_code, const std::string& words) {
  print_error(words);
  std::fflush(nullptr);
  messenger_->abort(exit_code);
  std::_Exit(exit_code);
}

}  // namespace catoptric::cluster
