#include "sim/edge_correction.h"

#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <vector>

#include "base/units.h"

namespace catoptric::sim {
namespace {

double arc_cosine(double x) { return std::acos(std::clamp(x, -1.0, 1.0)); }

/// How much of the circle of radius rho about a point at distance s from the disc's centre lies on the disc.
double angle_inside_disc(double rho, double s, double radius) {
  if (rho + s <= radius) return 2 * pi;
  if (rho >= radius + s || s == 0) return 0;
  return 2 * arc_cosine((s * s + rho * rho - radius * radius) / (2 * s * rho));
}

/// Distances from the point to the four edges in turn: right, upper, left, lower.
using EdgeDistances = std::array<double, 4>;

/// How much of the circle lies inside the rectangle: each edge cuts an arc off, and arcs of neighbouring
/// edges overlap where the corner between them lies inside the circle.
double angle_inside_rectangle(double rho, const EdgeDistances& edges) {
  std::array<double, 4> half_arc{};
  for (std::size_t i = 0; i < 4; ++i) half_arc[i] = edges[i] < rho ? arc_cosine(edges[i] / rho) : 0.0;
  double angle = 2 * pi;
  for (std::size_t i = 0; i < 4; ++i) {
    angle -= 2 * half_arc[i];
    angle += std::max(0.0, half_arc[i] + half_arc[(i + 1) % 4] - 0.5 * pi);
  }
  return std::max(0.0, angle);
}

/// Integral over t in [0, 1] of a function whose slope is infinite like a square root at the `breaks`; the
/// substitution by sin^2 removes that.
template <typename Function>
double integrate_between(std::vector<double> breaks, const Function& function) {
  breaks.push_back(0);
  breaks.push_back(1);
  std::sort(breaks.begin(), breaks.end());
  double sum = 0;
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
    const double low = breaks[i], width = breaks[i + 1] - breaks[i];
    if (!(width > 0)) continue;
    sum += boost::math::quadrature::gauss<double, 20>::integrate(
        [&](double x) {
          const double sine = std::sin(0.5 * pi * x);
          return function(low + width * sine * sine) * width * 0.5 * pi * std::sin(pi * x);
        },
        0.0, 1.0);
  }
  return sum;
}

/// Mass of the kernel where angle(rho) of each circle of radius rho is inside.
template <typename Angle>
double mass(Kernel kernel, double radius, const std::vector<double>& break_radii, const Angle& angle) {
  std::vector<double> breaks;
  for (double each : break_radii)
    if (each > 0 && each < radius) breaks.push_back(each / radius);
  return integrate_between(std::move(breaks),
                           [&](double t) { return kernel_value(kernel, t) * t * angle(t * radius) / pi; });
}

}  // namespace

double kernel_mass_inside(Kernel kernel, double radius_mm, const RecordedArea& area,
                          const Vector2& plane_mm) {
  if (area.shape == NearField::Shape::disc) {
    const double s = plane_mm.norm(), edge = area.half_width_mm;
    if (s + radius_mm <= edge) return 1;
    return mass(kernel, radius_mm, {edge - s, edge + s},
                [&](double rho) { return angle_inside_disc(rho, s, edge); });
  }
  EdgeDistances edges{area.half_width_mm - plane_mm.x(), area.half_height_mm - plane_mm.y(),
                      area.half_width_mm + plane_mm.x(), area.half_height_mm + plane_mm.y()};
  for (double& each : edges) each = std::max(0.0, each);
  if (*std::min_element(edges.begin(), edges.end()) >= radius_mm) return 1;
  std::vector<double> breaks(edges.begin(), edges.end());
  for (std::size_t i = 0; i < 4; ++i) breaks.push_back(std::hypot(edges[i], edges[(i + 1) % 4]));
  return mass(kernel, radius_mm, breaks, [&](double rho) { return angle_inside_rectangle(rho, edges); });
}

}  // namespace catoptric::sim
