#include "base/intensity_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/contract.h"
#include "base/errors.h"
#include "base/ordered_sum.h"
#include "base/units.h"

namespace catoptric {
namespace {

constexpr double greatest_intensity = 1e100;  // far above any light, and sums of it stay finite
constexpr double rad_per_degree = pi / 180;

[[noreturn]] void refuse_table(std::string what, std::string why) {
  throw InputError({std::move(what), "intensity table", std::move(why), ""});
}

void require_ascending(const std::vector<double>& angles, std::string_view name) {
  for (std::size_t i = 0; i < angles.size(); ++i) {
    if (!std::isfinite(angles[i]))
      refuse_table(fmt::format("{} angle {} is not finite", name, i + 1), "angles are finite");
    if (i > 0 && !(angles[i] - angles[i - 1] >= least_angle_step_deg))
      refuse_table(fmt::format("{} angle {} is {} after {}", name, i + 1, angles[i], angles[i - 1]),
                   "angles ascend, none is there twice");
  }
}

/// Which angle begins the piece that holds `angle`, and how far into the piece it is (0 to 1).
struct Place {
  std::size_t index;
  double share;
};

Place place_of(const std::vector<double>& angles, double angle) {
  const auto above = std::upper_bound(angles.begin(), angles.end(), angle);
  const auto index = static_cast<std::size_t>(std::max<std::ptrdiff_t>(above - angles.begin() - 1, 0));
  const double next = index + 1 < angles.size() ? angles[index + 1] : 360;
  return {index, (angle - angles[index]) / (next - angles[index])};
}

/// sin(x)/x - cos(x) without cancellation.
double sinc_less_cos(double x) {
  if (x > 0.5) return std::sin(x) / x - std::cos(x);
  double term = x * x / 3, sum = 0;  // of order 2k: -(-x^2)^k 2k / (2k + 1)!
  for (int k = 1; k <= 8; ++k) {
    sum += term;
    term *= -x * x * (k + 1) / (k * (2.0 * k + 2) * (2.0 * k + 3));
  }
  return sum;
}

/// Integral of sin(gamma) times the line from `first` at a to `last` at b; angles in rad. With m the middle
/// and h half the width, the weights' sum is 2 sin m sin h and their difference 2 cos m (sin h / h - cos h).
double zone_integral(double a, double b, double first, double last) {
  const double middle = (a + b) / 2, half = (b - a) / 2;
  return (first + last) * std::sin(middle) * std::sin(half) +
         (last - first) * std::cos(middle) * sinc_less_cos(half);
}

}  // namespace

IntensityTable::IntensityTable(LightQuantity quantity, std::vector<double> gamma_deg,
                               std::vector<double> c_deg, std::vector<double> values)
    : quantity_(quantity),
      gamma_deg_(std::move(gamma_deg)),
      c_deg_(std::move(c_deg)),
      values_(std::move(values)) {
  require_ascending(gamma_deg_, "gamma");
  require_ascending(c_deg_, "C");
  if (gamma_deg_.size() < 2 || (gamma_deg_.front() != 0 && gamma_deg_.front() != 90) ||
      (gamma_deg_.back() != 90 && gamma_deg_.back() != 180))
    refuse_table(gamma_deg_.size() < 2 ? "there are less than two gamma angles"
                                       : fmt::format("gamma angles go from {} to {} degrees",
                                                     gamma_deg_.front(), gamma_deg_.back()),
                 "they go from 0 to 90, from 90 to 180 or from 0 to 180 degrees");
  if (c_deg_.empty() || c_deg_.front() != 0 || c_deg_.back() > 360 - least_angle_step_deg)
    refuse_table("C angles are no full turn", "they begin at 0 and end below 360 degrees");
  if (values_.size() != gamma_deg_.size() * c_deg_.size())
    refuse_table(fmt::format("there are {} intensities for {} planes of {} angles", values_.size(),
                             c_deg_.size(), gamma_deg_.size()),
                 "there is one for each pair of angles");
  for (std::size_t i = 0; i < values_.size(); ++i)
    if (!(values_[i] >= 0 && values_[i] <= greatest_intensity))
      refuse_table(fmt::format("intensity {} is {} {}", i + 1, values_[i], intensity_unit(quantity_)),
                   "intensities lie between 0 and 1e100");
}

double IntensityTable::at(double gamma_deg, double c_deg) const {
  CATOPTRIC_EXPECTS(std::isfinite(c_deg));
  if (!(gamma_deg >= gamma_deg_.front() && gamma_deg <= gamma_deg_.back())) return 0;
  const auto along = [&](std::size_t plane) {
    const Place place = place_of(gamma_deg_, gamma_deg);
    if (place.index + 1 == gamma_deg_.size()) return value(plane, place.index);
    return std::lerp(value(plane, place.index), value(plane, place.index + 1), place.share);
  };
  if (is_rotational()) return along(0);
  double turn = std::fmod(c_deg, 360);
  if (turn < 0) turn += 360;
  if (turn >= 360) turn = 0;  // what is less than a rounding below 0
  const Place place = place_of(c_deg_, turn);
  return std::lerp(along(place.index), along((place.index + 1) % c_deg_.size()), place.share);
}

double IntensityTable::zonal_flux(double from_deg, double to_deg) const {
  CATOPTRIC_EXPECTS(from_deg >= 0 && from_deg <= to_deg && to_deg <= 180);
  CompensatedSum sum;
  for (std::size_t plane = 0; plane < c_deg_.size(); ++plane) {
    // A plane counts for half of the way to each neighbour.
    const double before = plane == 0 ? c_deg_.back() - 360 : c_deg_[plane - 1];
    const double after = plane + 1 == c_deg_.size() ? 360 : c_deg_[plane + 1];
    const double width = is_rotational() ? 2 * pi : (after - before) / 2 * rad_per_degree;
    for (std::size_t i = 0; i + 1 < gamma_deg_.size(); ++i) {
      const double begin = gamma_deg_[i], end = gamma_deg_[i + 1];
      const double a = std::max(begin, from_deg), b = std::min(end, to_deg);
      if (a >= b) continue;
      const double first = value(plane, i), last = value(plane, i + 1);
      sum.add(width * zone_integral(a * rad_per_degree, b * rad_per_degree,
                                    std::lerp(first, last, (a - begin) / (end - begin)),
                                    std::lerp(first, last, (b - begin) / (end - begin))));
    }
  }
  return sum.value();
}

double IntensityTable::maximum() const { return *std::max_element(values_.begin(), values_.end()); }

}  // namespace catoptric
