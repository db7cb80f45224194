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

/// A probe of engine `meridian`; what make_meridian_reflector(...)->probe() returns.
class MeridianProbe : public Probe {
 public:
  const MeridianCounts& counts() const { return counts_; }

 protected:
  MeridianCounts counts_;
};

}  // namespace catoptric::cad
