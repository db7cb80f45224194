#include "design/flux_map.h"

#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/tools/roots.hpp>
#include <cmath>

#include "base/contract.h"
#include "base/units.h"

namespace catoptric::design {
namespace {

constexpr std::size_t panels = 256;  ///< over all stretches together: cubics then leave 1e-9

double power(double base, double exponent) { return base > 0 ? std::pow(base, exponent) : 0.0; }

}  // namespace

PolarFlux polar_flux(double power_w, double exponent, bool towards_apex) {
  if (exponent == 0)
    return {[=](double angle) { return 0.5 * power_w * (1 - std::cos(angle)); },
            [=](double angle) { return 0.5 * power_w * std::sin(angle); }};
  const double n = exponent;
  if (towards_apex)
    return {[=](double angle) { return power_w * (1 - power(std::cos(angle), n + 1)); },
            [=](double angle) { return power_w * (n + 1) * power(std::cos(angle), n) * std::sin(angle); }};
  return {[=](double angle) { return power_w * power(-std::cos(angle), n + 1); },
          [=](double angle) { return power_w * (n + 1) * power(-std::cos(angle), n) * std::sin(angle); }};
}

FluxMap::FluxMap(PolarFlux source, double reflectance, const WantedLight& wanted)
    : source_(std::move(source)), reflectance_(reflectance) {
  CATOPTRIC_EXPECTS(reflectance > 0 && wanted.end_mm > 0);
  std::vector<double> stretches{0.0};
  for (const double each : wanted.breaks_mm)
    if (each > stretches.back() && each < wanted.end_mm) stretches.push_back(each);
  stretches.push_back(wanted.end_mm);
  const auto light = [&](double radius_mm) { return std::max(0.0, wanted.w_per_mm2(radius_mm)); };
  // Values at breaks are taken from within the stretch.
  constexpr double within = 1e-12;
  double flux = 0;
  for (std::size_t stretch = 0; stretch + 1 < stretches.size(); ++stretch) {
    const double first = stretches[stretch], length = stretches[stretch + 1] - first;
    const auto count =
        std::max<std::size_t>(8, static_cast<std::size_t>(std::ceil(panels * length / wanted.end_mm)));
    const auto rise_at = [&](double radius_mm) {
      const double there = light(radius_mm);
      return there > 0 ? 1 / (pi * there) : HUGE_VAL;
    };
    if (stretch > 0) {
      placed_.back().rise_after = rise_at(first + within * length);
      break_flux_w_.push_back(flux);
    } else {
      const double rise = rise_at(within * length);
      placed_.push_back({0, 0, rise, rise});
    }
    for (std::size_t i = 0; i < count; ++i) {
      const double low = first + length * static_cast<double>(i) / static_cast<double>(count);
      const double high = first + length * static_cast<double>(i + 1) / static_cast<double>(count);
      flux += boost::math::quadrature::gauss<double, 7>::integrate(
          [&](double radius_mm) { return 2 * pi * radius_mm * light(radius_mm); }, low, high);
      const double rise = rise_at(i + 1 == count ? high - within * length : high);
      placed_.push_back({flux, high * high, rise, rise});
    }
  }
  last_angle_rad_ = angle_of(flux);
}

double FluxMap::angle_of(double flux_w) const {
  const double emitted = flux_w / reflectance_;
  if (!(source_.within_w(pi) > emitted)) return pi;
  std::uintmax_t most = 200;
  const auto bracket =
      boost::math::tools::toms748_solve([&](double angle) { return source_.within_w(angle) - emitted; }, 0.0,
                                        pi, boost::math::tools::eps_tolerance<double>(50), most);
  return 0.5 * (bracket.first + bracket.second);
}

std::vector<double> FluxMap::break_angles_rad() const {
  std::vector<double> angles;
  for (const double flux : break_flux_w_) {
    if (!(flux > 0)) continue;  // the light begins there: no ray goes nearer to the axis
    if (const double angle = angle_of(flux); angle < last_angle_rad_) angles.push_back(angle);
  }
  return angles;
}

Landing FluxMap::at(double angle_rad) const {
  const double flux = reflectance_ * source_.within_w(angle_rad);
  if (flux >= placed_.back().flux_w) return {std::sqrt(placed_.back().square_mm2), 0};
  // The last node with no more than that flux: nodes of a dark stretch share theirs.
  const auto next = std::upper_bound(placed_.begin(), placed_.end(), flux,
                                     [](double value, const Node& node) { return value < node.flux_w; });
  const Node &a = *(next - 1), &b = *next;
  const double width = b.flux_w - a.flux_w, t = (flux - a.flux_w) / width;
  const double chord = (b.square_mm2 - a.square_mm2) / width;
  // Where the light comes near to none, slopes without bound would make the cubic swing: three chords keep
  // it rising (Fritsch & Carlson 1980).
  const double rise_a = std::min(a.rise_after, 3 * chord), rise_b = std::min(b.rise_before, 3 * chord);
  const double bend = rise_a + rise_b - 2 * chord;
  const double square =
      a.square_mm2 + width * t * (rise_a + t * (3 * chord - 2 * rise_a - rise_b + t * bend));
  const double rise = rise_a + t * (2 * (3 * chord - 2 * rise_a - rise_b) + t * 3 * bend);
  const double radius = std::sqrt(std::max(0.0, square));
  const double rate = reflectance_ * source_.per_angle_w(angle_rad);
  // On the axis radius and rate vanish together: there the radius is straight in the angle.
  return {radius, radius > 0 ? rise * rate / (2 * radius) : 0.0};
}

}  // namespace catoptric::design
