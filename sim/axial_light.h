#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/units.h"
#include "sim/cosine_law.h"
#include "sim/source.h"

namespace catoptric::sim {

/// The light of a point source that is the same all round the z axis, by emission angle from +z.
struct AxialLight {
  double power_w = 0;
  CosineLaw law = {};
  double up = 1;  ///< -1 where the source's axis is -z

  /// @in a source with no tilt
  static AxialLight of(const PointSource& source) {
    return {source.power_w(), source.law(), source.axis().z() < 0 ? -1.0 : 1.0};
  }

  /// Intensity over that of a source of this power that shines evenly.
  double relative(double cosine) const {
    return law.is_even() ? 1 : 2 * (law.exponent + 1) * law(up * cosine);
  }
  double relative_at(double theta_rad) const { return law.is_even() ? 1 : relative(std::cos(theta_rad)); }

  /// How much faster than by 1 per radian the intensity falls or rises, as a share of itself.
  double steepness(double theta_rad) const {
    return law.is_even() ? 0 : law.exponent * std::abs(std::tan(theta_rad));
  }

  /// The share of the power that goes between two emission angles, low < high.
  double share(double low_rad, double high_rad) const {
    // Half the difference of cosines, without their cancellation.
    const double half = std::sin(0.5 * (low_rad + high_rad)) * std::sin(0.5 * (high_rad - low_rad));
    if (law.is_even()) return half;
    const double near = up * std::cos(up > 0 ? low_rad : high_rad);
    const double far = std::max(0.0, up * std::cos(up > 0 ? high_rad : low_rad));
    const double power = law.exponent + 1;
    if (!(near > 0)) return 0;
    // near^power - far^power, where near = far + 2 half; of near ones without their cancellation.
    if (!(2 * half < far)) return std::pow(near, power) - std::pow(far, power);
    return std::pow(far, power) * std::expm1(power * std::log1p(2 * half / far));
  }

  /// Of ascending angles from 0 to pi those between which there is light, its end included.
  std::vector<double> lit(std::vector<double> angles) const {
    if (law.is_even()) return angles;
    const auto middle = std::lower_bound(angles.begin(), angles.end(), 0.5 * pi);
    if (up > 0) {
      angles.erase(middle, angles.end());
      angles.push_back(0.5 * pi);
    } else {
      angles.erase(angles.begin(), middle);
      if (angles.empty() || angles.front() > 0.5 * pi) angles.insert(angles.begin(), 0.5 * pi);
    }
    return angles;
  }
};

}  // namespace catoptric::sim
