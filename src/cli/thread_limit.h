#pragma once

#include <tbb/global_control.h>
#include <tbb/info.h>

namespace catoptric::cli {

/// How many threads a run uses, for as long as the object lives; 0: one per core.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads)
      : control_(tbb::global_control::max_allowed_parallelism,
                 static_cast<std::size_t>(threads > 0 ? threads : tbb::info::default_concurrency())) {}

 private:
  tbb::global_control control_;
};

}  // namespace catoptric::cli
