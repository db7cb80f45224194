#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>

#include "base/units.h"
#include "design/radial_target.h"
#include "design/search_methods.h"
#include "sim/kernel.h"

namespace catoptric::design {
namespace {

/// Mean of f(distance from the axis) under a kernel whose centre is `at_mm` off the axis.
template <class Function>
double blurred(sim::Kernel kernel, double kernel_radius_mm, double at_mm, const Function& f) {
  constexpr int azimuths = 24;  // of the half turn; beside a jump the mean errs by about 1 % of the jump
  return boost::math::quadrature::gauss<double, 15>::integrate(
      [&](double t) {
        const double ring_mm = kernel_radius_mm * t;
        double sum = 0;
        for (int i = 0; i < azimuths; ++i) {
          const double angle = pi * (i + 0.5) / azimuths;
          sum += f(std::sqrt(
              std::max(0.0, at_mm * at_mm + ring_mm * ring_mm + 2 * at_mm * ring_mm * std::cos(angle))));
        }
        return 2 * t * sim::kernel_value(kernel, t) * sum / azimuths;
      },
      0.0, 1.0);
}

}  // namespace

Target blurred_target(const Scene& scene) {
  Target target = make_target(scene);
  const auto wanted = radial_target(scene);
  if (!wanted) return target;  // a reference reflector's light has the scene's kernel already
  const auto source = make_source(scene.source);
  const auto direct = [&](double radius_mm) {
    return source->unhindered_w_per_mm2({radius_mm, 0, scene.near_field.center_mm().z()},
                                        scene.near_field.normal());
  };
  // Only what the mirror is to give is seen through the kernel.
  const auto reflected = [&](double radius_mm) {
    return std::max(0.0, wanted->total_w_per_mm2(radius_mm) - direct(radius_mm));
  };
  for (std::size_t i = 0; i < target.samples.size(); ++i) {
    const double radius_mm = std::hypot(target.samples[i].point_mm.x(), target.samples[i].point_mm.y());
    target.irradiance_w_per_mm2[i] +=
        blurred(scene.model.estimate.kernel, *scene.model.estimate.kernel_radius_mm, radius_mm, reflected) -
        reflected(radius_mm);
  }
  return target;
}

}  // namespace catoptric::design
