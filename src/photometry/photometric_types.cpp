#include "photometry/photometric_types.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"

namespace catoptric::photometry {
namespace {

constexpr double degree = pi / 180;

double finest_step(const std::vector<double>& angles) {
  double step = 180;
  for (std::size_t i = 1; i < angles.size(); ++i) step = std::min(step, angles[i] - angles[i - 1]);
  return step;
}

/// Angles from 0 to `end` with the same step, no wider than that.
std::vector<double> even_angles(double end, double widest_step) {
  const double steps = std::ceil(end / widest_step);
  std::vector<double> angles;
  for (int i = 0; i <= static_cast<int>(steps); ++i) angles.push_back(i == steps ? end : i * (end / steps));
  return angles;
}

/// The measured half sphere, mirrored where its angles begin at 0.
class MeasuredField {
 public:
  explicit MeasuredField(const Lm63File& file) : file_(file) {}

  double at(double horizontal_deg, double vertical_deg) const {
    const auto& h = file_.horizontal_deg;
    const auto& v = file_.vertical_deg;
    if (h.front() == 0) horizontal_deg = std::abs(horizontal_deg);
    if (v.front() == 0) vertical_deg = std::abs(vertical_deg);
    if (horizontal_deg < h.front() || horizontal_deg > h.back() || vertical_deg < v.front() ||
        vertical_deg > v.back())
      return 0;
    const std::size_t i = piece(h, horizontal_deg), k = piece(v, vertical_deg);
    const double across = (horizontal_deg - h[i]) / (h[i + 1] - h[i]);
    const double up = (vertical_deg - v[k]) / (v[k + 1] - v[k]);
    const auto column = [&](std::size_t plane) {
      return std::lerp(value(plane, k), value(plane, k + 1), up);
    };
    return std::lerp(column(i), column(i + 1), across);
  }

 private:
  static std::size_t piece(const std::vector<double>& angles, double angle) {
    const auto above = std::upper_bound(angles.begin(), angles.end() - 1, angle);
    return static_cast<std::size_t>(std::max<std::ptrdiff_t>(above - angles.begin() - 1, 0));
  }
  double value(std::size_t plane, std::size_t row) const {
    return file_.candela[plane * file_.vertical_deg.size() + row];
  }

  const Lm63File& file_;
};

}  // namespace

IntensityTable resampled_as_type_c(const Lm63File& file) {
  constexpr double finest = 0.25, coarsest = 5;  // degrees
  const double step = std::clamp(std::min(finest_step(file.horizontal_deg), finest_step(file.vertical_deg)),
                                 finest, coarsest);
  const std::vector<double> gamma = even_angles(90, step);
  std::vector<double> c_deg = even_angles(360, step);
  c_deg.pop_back();
  const MeasuredField field(file);
  const double factor = candela_factor(file);
  const auto half_circle = [](double radians) { return std::clamp(radians / degree, -90.0, 90.0); };
  std::vector<double> values;
  values.reserve(gamma.size() * c_deg.size());
  for (const double c : c_deg)
    for (const double g : gamma) {
      const double x = std::sin(g * degree) * std::cos(c * degree);
      const double y = std::sin(g * degree) * std::sin(c * degree);
      const double z = g == 90 ? 0 : std::cos(g * degree);
      values.push_back(factor * (file.type == PhotometricType::a
                                     ? field.at(half_circle(std::atan2(x, z)), half_circle(std::asin(y)))
                                     : field.at(half_circle(std::asin(x)), half_circle(std::atan2(y, z)))));
    }
  return {LightQuantity::luminous, gamma, std::move(c_deg), std::move(values)};
}

}  // namespace catoptric::photometry
