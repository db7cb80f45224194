#include "design/target_smoothing.h"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>

#include "sim/tube_kernel.h"

namespace catoptric::design {
namespace {

/// Mean of t^2 under a kernel; Silverman: 1/4.
double second_moment(sim::Kernel kernel) {
  return boost::math::quadrature::gauss<double, 30>::integrate(
      [&](double t) { return sim::kernel_value(kernel, t) * t * t * 2 * t; }, 0.0, 1.0);
}

}  // namespace

std::vector<double> kernel_means(const std::function<double(double)>& function, std::vector<double> breaks_mm,
                                 std::span<const double> radii_mm, sim::Kernel kernel,
                                 double kernel_radius_mm) {
  const double h = kernel == sim::Kernel::silverman ? kernel_radius_mm
                                                    : kernel_radius_mm * std::sqrt(4 * second_moment(kernel));
  std::vector<double> means;
  for (double at : radii_mm) {
    const double low = std::max(0.0, at - h), high = at + h;
    std::vector<double> panels{low, high};
    for (double place : breaks_mm)
      if (place > low && place < high) panels.push_back(place);
    if (h > at && h - at > low) panels.push_back(h - at);  // rings up to here lie wholly under the kernel
    std::sort(panels.begin(), panels.end());
    double sum = 0;
    for (std::size_t i = 1; i < panels.size(); ++i) {
      const double middle = 0.5 * (panels[i] + panels[i - 1]), half = 0.5 * (panels[i] - panels[i - 1]);
      // x = (3 t - t^3) / 2 flattens the kernel's root-like ends
      sum += boost::math::quadrature::gauss<double, 30>::integrate(
          [&](double t) {
            const double ring = middle + half * 0.5 * t * (3 - t * t);
            return half * 1.5 * (1 - t * t) * ring * function(ring) *
                   sim::kernel_ring_mean(at / h, ring / h).value;
          },
          -1.0, 1.0);
    }
    means.push_back(2 * pi * sim::kernel_peak_per_mm2(h) * sum);
  }
  return means;
}

}  // namespace catoptric::design
