#pragma once

#include <boost/math/quadrature/gauss.hpp>
#include <cmath>

#include "base/ray.h"
#include "base/units.h"
#include "sim/kernel.h"

namespace catoptric::test {

/// What a fixed-radius estimate at `at` expects of a field E(plane point): the mean under the kernel. With it
/// a test needs no allowance for bias. The field must be smooth inside the kernel.
template <typename Field>
double smoothed(sim::Kernel kernel, double radius, const Vector2& at, const Field& field) {
  constexpr int azimuths = 64;
  return boost::math::quadrature::gauss<double, 20>::integrate(
      [&](double t) {
        double ring = 0;
        for (int i = 0; i < azimuths; ++i) {
          const double angle = 2 * pi * (i + 0.5) / azimuths;
          ring += field(Vector2(at + radius * t * Vector2(std::cos(angle), std::sin(angle))));
        }
        return 2 * t * sim::kernel_value(kernel, t) * ring / azimuths;
      },
      0.0, 1.0);
}

}  // namespace catoptric::test
