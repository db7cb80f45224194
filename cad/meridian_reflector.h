#pragma once

#include <cstdint>

#include "base/ray.h"

namespace catoptric::cad {

/// What a probe of engine `meridian` has done, for benchmarks and tests.
struct MeridianCounts {
  std::uint64_t rays = 0;          ///< asked
  std::uint64_t halved = 0;        ///< pieces whose coefficient signs alone did not tell the number of hits
  std::uint64_t exact = 0;         ///< rays done in 113-bit arithmetic
  std::uint64_t side_by_side = 0;  ///< rays of a batch that were not done one by one
};

/// Whether this processor answers the rays of a batch several at a time. The plain copy of that code has the
/// same results, but compares number by number: 0.4 to 0.6 of the rate of single rays, which it leaves the
/// batch to. Sanitizers are shown it nevertheless.
bool meridian_works_side_by_side();

/// A probe of engine `meridian`; what make_meridian_reflector(...)->probe() returns.
class MeridianProbe : public Probe {
 public:
  const MeridianCounts& counts() const { return counts_; }

 protected:
  MeridianCounts counts_;
};

}  // namespace catoptric::cad
