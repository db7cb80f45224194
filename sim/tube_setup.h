#pragma once

#include <algorithm>
#include <numeric>
#include <span>
#include <vector>

#include "sim/tube_map.h"
#include "sim/tubes.h"

namespace catoptric::sim {

/// The radii asked for, each once and ascending: grids have many alike.
struct FieldRadii {
  std::vector<double> distinct_mm;
  std::vector<std::size_t> places;  ///< of each radius asked for

  explicit FieldRadii(std::span<const double> radii_mm) : places(radii_mm.size()) {
    std::vector<std::size_t> order(radii_mm.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    if (!std::is_sorted(radii_mm.begin(), radii_mm.end()))
      std::sort(order.begin(), order.end(),
                [&](std::size_t a, std::size_t b) { return radii_mm[a] < radii_mm[b]; });
    for (const std::size_t i : order) {
      if (distinct_mm.empty() || radii_mm[i] != distinct_mm.back()) distinct_mm.push_back(radii_mm[i]);
      places[i] = distinct_mm.size() - 1;
    }
  }
};

/// The tracer and the tubes that tubes_field takes.
/// @fails as tubes_field
TubeTracer tracer_for(const PointSource& source, const Profile& profile, const Material& mirror,
                      const FieldPlane& plane, const TubesOptions& options);
TubeMap map_for(const TubeTracer& tracer, const PointSource& source, const Profile& profile,
                const FieldRadii& radii, const TubesOptions& options);

}  // namespace catoptric::sim
