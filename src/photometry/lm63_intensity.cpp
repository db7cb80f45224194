#include <algorithm>
#include <cmath>
#include <utility>

#include "base/units.h"
#include "photometry/lm63.h"
#include "photometry/lm63_angles.h"
#include "photometry/photometric_types.h"

namespace catoptric::photometry {
namespace {

/// A plane of the full turn, and which of the file's planes holds its values.
using TurnPlane = std::pair<double, std::size_t>;

std::vector<TurnPlane> full_turn(const std::vector<double>& horizontal_deg) {
  const PlaneSymmetry symmetry = plane_symmetry(horizontal_deg);
  if (symmetry == PlaneSymmetry::rotational) return {{0, 0}};
  std::vector<TurnPlane> planes;
  for (std::size_t i = 0; i < horizontal_deg.size(); ++i) {
    const double c = horizontal_deg[i];
    if (c < 360) planes.emplace_back(c, i);
    const bool across_c0 = symmetry == PlaneSymmetry::about_c0 || symmetry == PlaneSymmetry::quadrant;
    if (across_c0 && c > 0 && c < 180) planes.emplace_back(360 - c, i);
    if (symmetry == PlaneSymmetry::about_c90 && c > 90 && c < 270)
      planes.emplace_back(c <= 180 ? 180 - c : 540 - c, i);
    if (symmetry == PlaneSymmetry::quadrant && c < 90) planes.emplace_back(180 - c, i);
    if (symmetry == PlaneSymmetry::quadrant && c > 0 && c < 90) planes.emplace_back(180 + c, i);
  }
  std::sort(planes.begin(), planes.end());
  return planes;
}

}  // namespace

double candela_factor(const Lm63File& file) {
  const double of_lamps = file.version == Lm63Version::of_2019 ? 1 : file.ballast_lamp_factor;
  return file.multiplier * file.ballast_factor * of_lamps;
}

IntensityTable intensity_of(const Lm63File& file) {
  if (file.type != PhotometricType::c) return resampled_as_type_c(file);
  const double factor = candela_factor(file);
  const std::vector<TurnPlane> planes = full_turn(file.horizontal_deg);
  const std::size_t rows = file.vertical_deg.size();
  std::vector<double> c_deg, values;
  if (planes.front().first > 0) {  // only when 90 to 270 leave out 180
    const auto& [last_c, last] = planes.back();
    const auto& [first_c, first] = planes.front();
    const double share = (360 - last_c) / (360 - last_c + first_c);
    c_deg.push_back(0);
    for (std::size_t i = 0; i < rows; ++i)
      values.push_back(factor *
                       std::lerp(file.candela[last * rows + i], file.candela[first * rows + i], share));
  }
  for (const auto& [c, source] : planes) {
    c_deg.push_back(c);
    for (std::size_t i = 0; i < rows; ++i) values.push_back(factor * file.candela[source * rows + i]);
  }
  return {LightQuantity::luminous, file.vertical_deg, std::move(c_deg), std::move(values)};
}

LuminousOpening opening_of(const Lm63File& file) {
  constexpr double mm_per_foot = 304.8;
  const double unit_mm = file.units == Lm63Units::feet ? mm_per_foot : millimetres_per(LengthUnit::metre);
  LuminousOpening opening{std::abs(file.length) * unit_mm, std::abs(file.width) * unit_mm,
                          std::abs(file.height) * unit_mm, file.length < 0 || file.width < 0};
  // A circle may state its diameter once.
  if (opening.is_round && opening.along_c0_mm == 0) opening.along_c0_mm = opening.along_c90_mm;
  if (opening.is_round && opening.along_c90_mm == 0) opening.along_c90_mm = opening.along_c0_mm;
  return opening;
}

}  // namespace catoptric::photometry
