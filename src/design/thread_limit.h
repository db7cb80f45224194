#pragma once

#include <memory>

namespace catoptric::design {

/// How many threads a run uses, for as long as the object lives; 0: one per core.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);
  ~ThreadLimit();

 private:
  struct Control;
  std::unique_ptr<Control> control_;
};

}  // namespace catoptric::design
