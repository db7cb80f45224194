#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/errors.h"
#include "photometry/direct_ratio.h"
#include "photometry/eulumdat.h"
#include "photometry/eulumdat_scale.h"
#include "photometry/file_text.h"

namespace catoptric::photometry {
namespace {

double rounded_to(double value, double decimals) {
  return std::isfinite(value) ? std::round(value * decimals) / decimals : 0;
}

/// Whether every plane holds the values of the one that would stand for it, and lies where that one's image
/// is.
bool has_symmetry(const IntensityTable& table, EulumdatSymmetry symmetry) {
  const std::size_t planes = table.c_deg().size(), rows = table.gamma_deg().size();
  const std::size_t divisor = symmetry == EulumdatSymmetry::about_c0 ? 2 : 4;
  if (planes % divisor != 0) return false;
  const auto& c = table.c_deg();
  const auto mirrored = [&](std::size_t i) {
    const bool across_c0 = i == 0 || c[i] + c[planes - i] == 360;
    const bool across_c90 = std::remainder(c[i] + c[(planes / 2 + planes - i) % planes] - 180, 360) == 0;
    return (symmetry == EulumdatSymmetry::about_c90 || across_c0) &&
           (symmetry == EulumdatSymmetry::about_c0 || across_c90);
  };
  const auto stored = stored_planes(symmetry, planes);
  const auto sources = plane_sources(symmetry, planes);
  for (std::size_t i = 0; i < planes; ++i) {
    if (!mirrored(i)) return false;
    for (std::size_t k = 0; k < rows; ++k)
      if (table.value(i, k) != table.value(stored[sources[i]], k)) return false;
  }
  return true;
}

EulumdatSymmetry symmetry_of(const IntensityTable& table) {
  if (table.is_rotational()) return EulumdatSymmetry::rotational;
  for (const auto symmetry :
       {EulumdatSymmetry::both, EulumdatSymmetry::about_c0, EulumdatSymmetry::about_c90})
    if (has_symmetry(table, symmetry)) return symmetry;
  return EulumdatSymmetry::none;
}

void require_writable(const IntensityTable& table) {
  constexpr std::size_t most_planes = 721;
  if (table.quantity() != LightQuantity::luminous)
    throw InputError({"an intensity in W/sr is no candela", "EULUMDAT file",
                      "EULUMDAT holds photometric data",
                      "convert it with the luminous efficacy of its light first"});
  if (table.c_deg().size() > most_planes || table.gamma_deg().size() > most_eulumdat_angles)
    throw InputError(
        {fmt::format("the table has {} planes of {} angles", table.c_deg().size(), table.gamma_deg().size()),
         "EULUMDAT file", "the format has at most 721 planes of 361 angles",
         "take fewer angles, or write IES"});
  if (!(table.flux() > 0))
    throw InputError(
        {"the table is dark", "EULUMDAT file", "intensities are per 1000 lm of a flux above 0", ""});
}

/// Distance of angles that are evenly spaced, else 0.
double even_step(const std::vector<double>& angles, double end) {
  const double step = angles.size() < 2 ? 0 : angles[1] - angles[0];
  for (std::size_t i = 0; i < angles.size(); ++i)
    if (angles[i] != angles[0] + static_cast<double>(i) * step) return 0;
  return angles.back() == end || angles.back() + step == end ? step : 0;
}

/// The shortest text that the reader turns into the same intensity.
std::string stored_text(double intensity_cd, long double scale) {
  constexpr int fewest_digits = 15, most_digits = 21;  // 21 tell any two long doubles apart
  const long double stored = static_cast<long double>(intensity_cd) / scale;
  for (int digits = fewest_digits;; ++digits) {
    std::string text = fmt::format("{:.{}g}", stored, digits);
    long double read = 0;
    std::from_chars(text.data(), text.data() + text.size(), read);
    if (digits == most_digits || static_cast<double>(read * scale) == intensity_cd) return text;
  }
}

/// One line after the other.
class Lines {
 public:
  void add(std::string_view text, std::size_t most_bytes) { end(one_line(text, most_bytes)); }
  template <typename Number>
  void add(Number value) {
    end(fmt::format("{}", value));
  }
  void end(std::string_view line) {
    text_ += line;
    text_ += "\r\n";
  }
  std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

}  // namespace

EulumdatFile eulumdat_of(const IntensityTable& table, const Luminaire& luminaire) {
  require_writable(table);
  EulumdatFile file;
  file.company = luminaire.manufacturer;
  file.report = luminaire.test;
  file.luminaire = luminaire.name;
  file.catalog = luminaire.catalog;
  file.date = luminaire.issue_date;
  file.type = table.is_rotational() ? 1 : 3;
  file.symmetry = symmetry_of(table);
  const LuminousOpening& opening = luminaire.opening;
  file.length_mm = file.luminous_length_mm = opening.along_c90_mm;
  file.width_mm = file.luminous_width_mm = opening.is_round ? 0 : opening.along_c0_mm;
  file.height_mm = opening.height_mm;
  file.luminous_heights_mm.fill(opening.height_mm);
  constexpr double percent = 100, hundredths = 100, ten_thousandths = 10'000;
  const double flux = table.flux();
  file.downward_percent = rounded_to(percent * table.zonal_flux(0, 90) / flux, hundredths);
  const double lamp_flux = luminaire.lamp_flux_lm.value_or(flux);
  file.output_ratio_percent = rounded_to(percent * flux / lamp_flux, hundredths);
  const int count = luminaire.lamp_flux_lm ? luminaire.lamp_count : -luminaire.lamp_count;
  file.lamps.push_back({count, luminaire.lamp, lamp_flux, "", "", luminaire.input_w});
  for (std::size_t i = 0; i < room_indices.size(); ++i)
    file.direct_ratios[i] = rounded_to(direct_ratio(table, room_indices[i]), ten_thousandths);
  file.c_deg = table.c_deg();
  file.gamma_deg = table.gamma_deg();
  for (const std::size_t plane : stored_planes(file.symmetry, file.c_deg.size()))
    for (std::size_t i = 0; i < file.gamma_deg.size(); ++i)
      file.intensity_cd.push_back(table.value(plane, i));
  return file;
}

std::string eulumdat_text(const EulumdatFile& file) {
  constexpr std::size_t longest = 78, lamp_type = 24, file_name = 8, colour = 16,
                        rendering = 6;  // the format's
  Lines lines;
  lines.add(file.company, longest);
  lines.add(file.type);
  lines.add(static_cast<int>(file.symmetry));
  lines.add(file.c_deg.size());
  lines.add(even_step(file.c_deg, 360));
  lines.add(file.gamma_deg.size());
  lines.add(even_step(file.gamma_deg, file.gamma_deg.back()));
  for (const auto& text : {file.report, file.luminaire, file.catalog}) lines.add(text, longest);
  lines.add(file.file_name, file_name);
  lines.add(file.date, longest);
  for (const double size :
       {file.length_mm, file.width_mm, file.height_mm, file.luminous_length_mm, file.luminous_width_mm})
    lines.add(size);
  for (const double height : file.luminous_heights_mm) lines.add(height);
  for (const double number :
       {file.downward_percent, file.output_ratio_percent, file.conversion_factor, file.tilt_deg})
    lines.add(number);
  lines.add(file.lamps.size());
  for (const EulumdatLamps& lamps : file.lamps) {
    lines.add(lamps.count);
    lines.add(lamps.type, lamp_type);
    lines.add(lamps.flux_lm);
    lines.add(lamps.colour, colour);
    lines.add(lamps.rendering, rendering);
    lines.add(lamps.input_w);
  }
  for (const double ratio : file.direct_ratios) lines.add(ratio);
  for (const double angle : file.c_deg) lines.add(angle);
  for (const double angle : file.gamma_deg) lines.add(angle);
  const long double scale = cd_per_stored(file);
  for (const double intensity : file.intensity_cd) lines.end(stored_text(intensity, scale));
  return lines.take();
}

}  // namespace catoptric::photometry
