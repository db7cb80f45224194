#pragma once

#include <cmath>
#include <vector>

#include "base/profile.h"

namespace catoptric::test {

/// z = 100 mm - r^2 / 200 mm out to r = 100 mm: the paper's paraboloid of focal distance 50 mm.
inline Profile paraboloid(double scale = 1) {
  return Profile::bezier({{0, 100 * scale, 1}, {50 * scale, 100 * scale, 1}, {100 * scale, 50 * scale, 1}});
}

/// Half a sphere of radius R about the origin, open downwards.
inline Profile hemisphere(double radius_mm) {
  return Profile::bezier({{0, radius_mm, 1}, {radius_mm, radius_mm, std::sqrt(0.5)}, {radius_mm, 0, 1}});
}

/// Several spans of any degree, a smooth bowl with a wave in it; numbers without short decimals.
inline Profile wavy_profile(int degree, bool rational) {
  std::vector<ControlPoint> points;
  const int last = degree + 3;
  for (int i = 0; i <= last; ++i) {
    const double t = static_cast<double>(i) / last;
    points.push_back({100 * std::sin(t), 100 * std::cos(t), rational ? 1 + 0.3 * (i % 3) / 3 : 1});
  }
  points.front().r_mm = 0;
  points[1].z_mm = points[0].z_mm;  // meets the axis at a right angle
  return Profile(degree, Profile::uniform_knots(degree, points.size()), points);
}

/// Weights over the whole range a Profile allows.
inline Profile wild_weights_profile() {
  std::vector<ControlPoint> points;
  for (int i = 0; i < 9; ++i) {
    const double t = i / 8.0;
    points.push_back({100 * t, 100 - 50 * t * t, std::pow(10.0, 7.7 * (i % 3 - 1)) * (1 + i / 9.0)});
  }
  points[8].weight = 1e8;
  points[3].weight = 1e-8;
  return Profile(3, Profile::uniform_knots(3, 9), points);
}

/// Degree 4 with inner knots repeated 1 to 4 times: from smooth to a kink.
inline Profile multiple_knots_profile() {
  const std::vector<double> knots{0,   0,   0,   0,   0,   0.1, 0.3, 0.3, 0.6, 0.6,
                                  0.6, 0.7, 0.7, 0.7, 0.7, 1,   1,   1,   1,   1};
  std::vector<ControlPoint> points;
  const int last = static_cast<int>(knots.size()) - 4 - 2;
  for (int i = 0; i <= last; ++i) {
    const double t = static_cast<double>(i) / last;
    points.push_back({100 * t, 100 - 60 * t * t, 1 + 0.5 * ((3 * i) % 4) / 3});
  }
  return Profile(4, knots, points);
}

}  // namespace catoptric::test
