#pragma once

#include <cmath>
#include <vector>

#include "base/profile.h"
#include "base/random_stream.h"

namespace catoptric::test {

/// A rational profile with bumps, from the axis outwards, several spans, knots unevenly spaced.
inline Profile random_profile(int degree, std::uint64_t seed) {
  RandomStream random(seed, Purpose::test, 1000 + static_cast<std::uint64_t>(degree));
  const std::size_t count =
      static_cast<std::size_t>(degree) + 1 + static_cast<std::size_t>(4 * random.uniform());
  std::vector<ControlPoint> points;
  for (std::size_t i = 0; i < count; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(count - 1);
    const double r = i == 0 ? 0 : 80 * share * (0.8 + 0.4 * random.uniform());
    const double z = 60 * (1 - share * share) + 25 * (random.uniform() - 0.5);
    const double weight = std::exp2(4 * random.uniform() - 2);
    points.push_back({r, z, weight});
  }
  std::vector<double> knots = Profile::uniform_knots(degree, count);
  for (double& knot : knots) knot = std::pow(knot, 1.3);
  return Profile(degree, knots, points);
}

}  // namespace catoptric::test
