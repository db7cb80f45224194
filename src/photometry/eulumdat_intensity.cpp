#include <algorithm>

#include "photometry/eulumdat.h"

namespace catoptric::photometry {

std::vector<std::size_t> stored_planes(EulumdatSymmetry symmetry, std::size_t plane_count) {
  std::size_t first = 0, count = plane_count;
  switch (symmetry) {
    case EulumdatSymmetry::none:
      break;
    case EulumdatSymmetry::rotational:
      count = 1;
      break;
    case EulumdatSymmetry::about_c90:
      first = plane_count / 4 * 3;
      [[fallthrough]];
    case EulumdatSymmetry::about_c0:
      count = plane_count / 2 + 1;
      break;
    case EulumdatSymmetry::both:
      count = plane_count / 4 + 1;
      break;
  }
  std::vector<std::size_t> planes(count);
  for (std::size_t i = 0; i < count; ++i) planes[i] = (first + i) % plane_count;
  return planes;
}

std::vector<std::size_t> plane_sources(EulumdatSymmetry symmetry, std::size_t plane_count) {
  const std::vector<std::size_t> stored = stored_planes(symmetry, plane_count);
  std::vector<std::size_t> sources(plane_count, 0);
  if (symmetry == EulumdatSymmetry::rotational) return sources;
  const std::size_t half = plane_count / 2;
  for (std::size_t i = 0; i < stored.size(); ++i) {
    const std::size_t plane = stored[i];
    const std::size_t across_c0 = (plane_count - plane) % plane_count;          // C to 360 - C
    const std::size_t across_c90 = (half + plane_count - plane) % plane_count;  // C to 180 - C
    sources[plane] = i;
    if (symmetry == EulumdatSymmetry::about_c0 || symmetry == EulumdatSymmetry::both) sources[across_c0] = i;
    if (symmetry == EulumdatSymmetry::about_c90 || symmetry == EulumdatSymmetry::both)
      sources[across_c90] = i;
    if (symmetry == EulumdatSymmetry::both) sources[(half + plane) % plane_count] = i;
  }
  return sources;
}

IntensityTable intensity_of(const EulumdatFile& file) {
  if (file.symmetry == EulumdatSymmetry::rotational)
    return {LightQuantity::luminous, file.gamma_deg, {0}, file.intensity_cd};
  const std::size_t rows = file.gamma_deg.size();
  std::vector<double> values;
  values.reserve(rows * file.c_deg.size());
  for (const std::size_t source : plane_sources(file.symmetry, file.c_deg.size())) {
    const auto begin = file.intensity_cd.begin() + static_cast<std::ptrdiff_t>(source * rows);
    values.insert(values.end(), begin, begin + static_cast<std::ptrdiff_t>(rows));
  }
  return {LightQuantity::luminous, file.gamma_deg, file.c_deg, std::move(values)};
}

LuminousOpening opening_of(const EulumdatFile& file) {
  const double height = *std::max_element(file.luminous_heights_mm.begin(), file.luminous_heights_mm.end());
  const bool is_round = file.luminous_width_mm == 0 && file.luminous_length_mm > 0;
  const double across = is_round ? file.luminous_length_mm : file.luminous_width_mm;
  return {across, file.luminous_length_mm, height, is_round};
}

}  // namespace catoptric::photometry
