#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "fuzz/support/accepted.h"
#include "rayfiles/ray_check.h"
#include "rayfiles/ray_file.h"
#include "rayfiles/ray_picker.h"

namespace catoptric::fuzz {

/// What is written of a header that was read must be read as the same.
inline void check_header_again(const rayfiles::RayFile& rays) {
  const auto bytes_of = [](const std::string& text) {
    return std::span(reinterpret_cast<const std::byte*>(text.data()), text.size());
  };
  std::string once, again;
  if (const auto* const zemax = std::get_if<rayfiles::ZemaxHeader>(&rays.file_header())) {
    once = rayfiles::zemax_header_bytes(*zemax);
    again = rayfiles::zemax_header_bytes(rayfiles::read_zemax_header(bytes_of(once), "again").header);
  } else {
    once = rayfiles::tm25_header_bytes(std::get<rayfiles::Tm25Header>(rays.file_header()));
    again = rayfiles::tm25_header_bytes(rayfiles::read_tm25_header(bytes_of(once), "again").header);
  }
  if (once != again) finding("another header");
}

inline void check_statistics(const rayfiles::RaySet& rays, const rayfiles::RayStatistics& all) {
  constexpr double roundings = 1 + 1e-12;
  if (!(all.total_flux > 0 && all.total_flux < HUGE_VAL)) finding("a total flux that is none");
  if (!(all.sphere.radius_mm >= 0 && all.sphere.radius_mm < HUGE_VAL)) finding("a sphere without a radius");
  if (!(all.mean_direction.norm() <= roundings))
    finding("a mean of unit vectors that is longer than they are");
  const double half_box_mm = (all.highest_mm - all.lowest_mm).maxCoeff() / 2;
  if (!(all.sphere.radius_mm * roundings >= half_box_mm)) finding("a sphere smaller than the box");
  for (std::uint64_t i = 0; i < std::min<std::uint64_t>(rays.count(), 64); ++i)
    if (!(std::abs(rays.ray(i).direction.norm() - 1) < 1e-15 * 10)) finding("a direction that is not unit");
}

inline void check_picks(const std::shared_ptr<const rayfiles::RaySet>& rays) {
  const rayfiles::RayPicker picker(rays);
  rayfiles::PickedRay last{0, 0};
  constexpr int points = 64;
  for (int i = 0; i <= points; ++i) {
    const auto next = picker.pick(std::min(static_cast<double>(i) / points, 1 - 0x1p-53));
    if (next.ray >= rays->count() || !(rays->flux(next.ray) > 0))
      finding("a ray that is not there or has no flux");
    if (next.ray < last.ray || (next.ray == last.ray && next.rest < last.rest)) finding("picks out of order");
    if (!(next.rest >= 0 && next.rest < 1)) finding("a rest outside 0 to 1");
    last = next;
  }
}

/// Ray files. When the first byte is odd, the rest is a TM-25 file without its 36,000 bytes of descriptions,
/// which would leave little room for what counts.
inline void try_rayfile(std::string_view input) {
  if (input.empty()) return;
  static const InputFile file;
  std::string content(input.substr(1));
  constexpr std::size_t before_descriptions = 288;
  if (input[0] % 2 != 0 && content.size() >= before_descriptions)
    content.insert(before_descriptions, 36000, '\0');
  accepted([&] {
    const auto rays = rayfiles::RayFile::open(file.with(content.data(), content.size()));
    check_header_again(*rays);
    const rayfiles::RayCheck check = rayfiles::check_rays(*rays);
    rayfiles::require_sound(check);
    try {
      check_statistics(*rays, check.statistics);
      check_picks(rays);
    } catch (const Error& error) {
      finding(std::string("refused though it is sound: ") + error.what());
    }
  });
}

}  // namespace catoptric::fuzz
