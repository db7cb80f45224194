#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>

namespace catoptric::fuzz {

/// How far a child came with a batch of inputs.
struct BatchProgress {
  std::uint64_t done;   ///< inputs that ended
  bool died;            ///< on the one after them
  std::string finding;  ///< what the child said of an input that ended as none may; empty: nothing
};

/// Tries inputs 0 ... count - 1 in one forked child, so that a fork is not paid for each. The child dies of
/// the first input that crashes, takes longer than `limit` of the processor's time or more than 2 GiB.
/// @in    try_one hands back what is wrong with an input's end, or nothing; `ended` its class, a number
///        below 16, counted in `counts`
BatchProgress run_batch(std::uint64_t count, std::chrono::milliseconds limit,
                        const std::function<std::string(std::uint64_t, unsigned& ended)>& try_one,
                        std::uint64_t (&counts)[16]);

}  // namespace catoptric::fuzz
