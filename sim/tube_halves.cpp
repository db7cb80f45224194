#include "sim/tube_halves.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace catoptric::sim {

std::optional<std::array<Tube, 2>> halves_of(const Tube& tube, const TubeTracer& tracer) {
  constexpr std::array<double, rays_of_halving> places{-1, -0.5, 0, 0.5, 1};
  std::array<Landing, rays_of_halving> rays;
  std::array<double, rays_of_halving> angles;
  std::vector<Landing> landings;
  for (std::size_t i = 0; i < places.size(); ++i) {
    angles[i] = i == 0 ? tube.first_rad : i + 1 == places.size() ? tube.last_rad : tube.theta_rad(places[i]);
    landings.clear();
    tracer.trace(angles[i], landings);
    const auto own = std::find_if(landings.begin(), landings.end(),
                                  [&](const Landing& landing) { return landing.path == tube.path; });
    if (own == landings.end()) return std::nullopt;
    rays[i] = *own;
  }
  double off_mm = 0, off_slope = 0, off_weight = 0;
  for (const std::size_t i : {1, 3}) {
    off_mm = std::max(off_mm, std::abs(tube.at(places[i]) - rays[i].rho_mm));
    off_slope = std::max(off_slope,
                         std::abs(tube.slope(places[i]) - tube.half_width_rad() * rays[i].slope_mm_per_rad));
    off_weight = std::max(off_weight, std::abs(tube.weight * tube.course.at(places[i]) - rays[i].weight));
  }
  constexpr double counted = 1.0 / 16;
  std::array<Tube, 2> halves;
  for (std::size_t side = 0; side < 2; ++side) {
    const Landing &a = rays[2 * side], &m = rays[2 * side + 1], &b = rays[2 * side + 2];
    Tube& half = halves[side];
    half = tube;
    half.first_rad = angles[2 * side];
    half.last_rad = angles[2 * side + 2];
    half.begin_mm = side == 0 ? tube.begin_mm : a.rho_mm;
    half.end_mm = side == 0 ? b.rho_mm : tube.end_mm;
    half.off_mm = counted * off_mm;
    half.off_slope = counted * off_slope;
    half.weight = std::max({a.weight, m.weight, b.weight});
    half.course = WeightCourse::through(a.weight, m.weight, b.weight, weight_misfit_counted * off_weight);
    const double width = half.half_width_rad();
    Hermite{half.begin_mm,
            m.rho_mm,
            half.end_mm,
            width * a.slope_mm_per_rad,
            width * m.slope_mm_per_rad,
            width * b.slope_mm_per_rad}
        .quintic(half.rho);
  }
  return halves;
}

}  // namespace catoptric::sim
