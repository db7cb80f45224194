#include "base/recorded_ranks.h"

#include <stdexcept>

#include "base/task_result.h"

namespace catoptric {

Bytes RecordingRanks::join(std::size_t count, const Compute& compute, const Take& take,
                           const Joined& joined) {
  // Joins inside a task are not asked again when its result is known.
  if (inside_) return Ranks::join(count, compute, take, joined);
  inside_ = true;
  log_.push_back(result_or_error([&] { return Ranks::join(count, compute, take, joined); }));
  inside_ = false;
  return result_of(log_.back());
}

Bytes RepeatingRanks::join(std::size_t, const Compute&, const Take&, const Joined&) {
  if (at_ == log_.size()) throw std::runtime_error("work that is repeated asks more than was recorded");
  return result_of(log_[at_++]);
}

}  // namespace catoptric
