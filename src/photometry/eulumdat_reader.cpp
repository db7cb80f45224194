#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "photometry/eulumdat.h"
#include "photometry/eulumdat_scale.h"
#include "photometry/file_text.h"
#include "photometry/meaning_lines.h"

namespace catoptric::photometry {
namespace {

struct Grid {
  int planes, angles;
  double plane_step, angle_step;
};

/// Lines 1 to 12.
Grid read_head(MeaningLines& lines, EulumdatFile& file, std::vector<std::string>& notes) {
  constexpr int most_planes = 721, most_angles = 361;
  Grid grid{};
  file.company = lines.text("company");
  file.type = lines.count("type indicator Ityp", 0, 3);
  file.symmetry = static_cast<EulumdatSymmetry>(lines.count("symmetry indicator Isym", 0, 4));
  if (file.type == 1 && file.symmetry != EulumdatSymmetry::rotational)
    notes.push_back("Ityp says symmetry about the vertical axis, Isym does not; Isym was taken.");
  grid.planes = lines.count("number Mc of C planes", 1, most_planes);
  const int divisor =
      file.symmetry == EulumdatSymmetry::about_c0                                               ? 2
      : file.symmetry == EulumdatSymmetry::about_c90 || file.symmetry == EulumdatSymmetry::both ? 4
                                                                                                : 1;
  if (grid.planes % divisor != 0)
    lines.refuse(
        fmt::format("it is {}", grid.planes), "number Mc of C planes",
        fmt::format("with Isym = {} it is a multiple of {}", static_cast<int>(file.symmetry), divisor));
  grid.plane_step = lines.optional_number("distance Dc of C planes");
  grid.angles = lines.count("number Ng of intensities in a plane", 2, most_angles);
  grid.angle_step = lines.optional_number("distance Dg of intensities in a plane");
  file.report = lines.text("measurement report number");
  file.luminaire = lines.text("luminaire name");
  file.catalog = lines.text("luminaire number");
  file.file_name = lines.text("file name");
  file.date = lines.text("date and user");
  return grid;
}

/// Lines 13 to 25.
void read_body(MeaningLines& lines, EulumdatFile& file, std::vector<std::string>& notes) {
  file.length_mm = lines.size("luminaire's length");
  file.width_mm = lines.size("luminaire's width");
  file.height_mm = lines.size("luminaire's height");
  file.luminous_length_mm = lines.size("luminous area's length");
  file.luminous_width_mm = lines.size("luminous area's width");
  constexpr std::array names{"luminous area's height at C0", "luminous area's height at C90",
                             "luminous area's height at C180", "luminous area's height at C270"};
  for (std::size_t i = 0; i < names.size(); ++i) file.luminous_heights_mm[i] = lines.size(names[i]);
  file.downward_percent = lines.optional_number("downward flux fraction DFF");
  if (!(file.downward_percent >= 0 && file.downward_percent <= 100))
    notes.push_back(
        fmt::format("The downward flux fraction is {} %; it was not used.", file.downward_percent));
  file.output_ratio_percent = lines.optional_number("light output ratio LORL");
  file.conversion_factor = lines.optional_number("conversion factor for intensities");
  if (file.conversion_factor == 0) {
    file.conversion_factor = 1;
    notes.push_back("The conversion factor for intensities is 0; 1 was taken.");
  }
  if (!(file.conversion_factor > 0))
    lines.refuse(fmt::format("it is {}", file.conversion_factor), "conversion factor for intensities",
                 "it is above 0");
  if (file.conversion_factor != 1)
    notes.push_back(
        fmt::format("Intensities were multiplied by the conversion factor {}.", file.conversion_factor));
  file.tilt_deg = lines.optional_number("tilt during measurement");
}

void read_lamps(MeaningLines& lines, EulumdatFile& file, std::vector<std::string>& notes) {
  constexpr int most_sets = 1000, most_lamps = 1'000'000;
  const int sets = lines.count("number of lamp sets", 1, most_sets);
  for (int i = 1; i <= sets; ++i) {
    EulumdatLamps lamps;
    const auto meaning = [&](std::string_view of) { return fmt::format("lamp set {}: {}", i, of); };
    lamps.count = lines.count(meaning("number of lamps"), -most_lamps, most_lamps);
    lamps.type = lines.text(meaning("type of lamps"));
    lamps.flux_lm = lines.number(meaning("total luminous flux"));
    if (!(lamps.flux_lm > 0))
      lines.refuse(fmt::format("it is {}", lamps.flux_lm), meaning("total luminous flux"),
                   "it is above 0: intensities are per 1000 lm of it");
    lamps.colour = lines.text(meaning("colour temperature"));
    lamps.rendering = lines.text(meaning("colour rendering"));
    lamps.input_w = lines.size(meaning("watts"));
    file.lamps.push_back(std::move(lamps));
  }
  if (sets > 1)
    notes.push_back(fmt::format("Of {} lamp sets the first was taken, {} lm.", sets, file.lamps[0].flux_lm));
}

/// Angles that are `step` apart, when the file says so.
void note_uneven(const std::vector<double>& angles, double step, std::string_view of,
                 std::vector<std::string>& notes) {
  constexpr double rounded = 0.01;  // degrees; the file may state a step of 7.5 as 7.50
  if (step == 0 || angles.size() < 2) return;
  for (std::size_t i = 0; i < angles.size(); ++i)
    if (std::abs(angles[i] - angles[0] - static_cast<double>(i) * step) > rounded) {
      notes.push_back(
          fmt::format("The {} angles are not {} degrees apart, as the file says; they were taken "
                      "as they stand.",
                      of, step));
      return;
    }
}

/// Planes that stand for others need others to stand for.
void check_mirrored(const MeaningLines& lines, const EulumdatFile& file) {
  constexpr double rounded = 0.01;  // degrees
  const auto sources = plane_sources(file.symmetry, file.c_deg.size());
  const auto stored = stored_planes(file.symmetry, file.c_deg.size());
  if (file.symmetry == EulumdatSymmetry::rotational) return;
  for (std::size_t i = 0; i < file.c_deg.size(); ++i) {
    const double c = file.c_deg[i], other = file.c_deg[stored[sources[i]]];
    const auto same = [&](double angle) { return std::abs(std::remainder(angle - c, 360)) <= rounded; };
    const bool about_c0 = file.symmetry != EulumdatSymmetry::about_c90;
    const bool about_c90 = file.symmetry != EulumdatSymmetry::about_c0;
    if (!same(other) && !(about_c0 && same(-other)) && !(about_c90 && same(180 - other)) &&
        !(about_c0 && about_c90 && same(180 + other)))
      lines.refuse(fmt::format("the plane at {} degrees has no mirror image", c), "C angles",
                   fmt::format("with Isym = {} planes come in pairs", static_cast<int>(file.symmetry)),
                   "check Isym and Mc");
  }
}

void read_angles(MeaningLines& lines, EulumdatFile& file, const Grid& grid, std::vector<std::string>& notes) {
  file.c_deg = lines.angles(grid.planes, "C angles");
  if (file.c_deg.front() != 0 || file.c_deg.back() > 360 - least_angle_step_deg)
    lines.refuse(fmt::format("they go from {} to {} degrees", file.c_deg.front(), file.c_deg.back()),
                 "C angles", "they begin at 0 and end below 360 degrees");
  check_mirrored(lines, file);
  note_uneven(file.c_deg, grid.plane_step, "C", notes);
  file.gamma_deg = lines.angles(grid.angles, "gamma angles");
  const double first = file.gamma_deg.front(), last = file.gamma_deg.back();
  if ((first != 0 && first != 90) || (last != 90 && last != 180))
    lines.refuse(fmt::format("they go from {} to {} degrees", first, last), "gamma angles",
                 "they go from 0 to 90, from 90 to 180 or from 0 to 180 degrees",
                 "add the missing angles, with 0 where it is dark");
  note_uneven(file.gamma_deg, grid.angle_step, "gamma", notes);
}

void read_intensities(MeaningLines& lines, EulumdatFile& file, std::vector<std::string>& notes) {
  constexpr std::string_view meaning = "intensities";
  const std::size_t rows = file.gamma_deg.size();
  const auto stored = stored_planes(file.symmetry, file.c_deg.size());
  lines.require_room(stored.size() * rows, meaning);
  const long double scale = cd_per_stored(file);
  for (std::size_t i = 0; i < stored.size() * rows; ++i) {
    const long double value = lines.number<long double>(meaning);
    constexpr long double too_bright = 1e100L;  // as IntensityTable has it
    if (!(value >= 0) || !(value * scale <= too_bright))
      lines.refuse(fmt::format("it is {} cd/klm at C = {}, gamma = {} degrees", static_cast<double>(value),
                               file.c_deg[stored[i / rows]], file.gamma_deg[i % rows]),
                   meaning, "intensities are not negative, and below 1e100 cd");
    file.intensity_cd.push_back(static_cast<double>(value * scale));
  }
  const std::string_view more = lines.remainder();
  if (more.empty()) return;
  if (more.find_first_not_of("0123456789.,+-eE") == std::string_view::npos)
    lines.refuse(fmt::format("\"{}\" follows the last value", cited(more)), meaning,
                 "there is one for each pair of stored plane and gamma angle", "check Mc, Ng and Isym");
  notes.push_back("Text behind the last intensity was left out.");
}

}  // namespace

EulumdatReading parse_eulumdat(std::string_view bytes, const std::string& name) {
  EulumdatReading reading;
  const std::string text = decoded(bytes, name, reading.notes);
  MeaningLines lines(text, name);
  EulumdatFile& file = reading.file;
  const Grid grid = read_head(lines, file, reading.notes);
  read_body(lines, file, reading.notes);
  read_lamps(lines, file, reading.notes);
  for (double& ratio : file.direct_ratios) ratio = lines.optional_number("direct ratios");
  read_angles(lines, file, grid, reading.notes);
  read_intensities(lines, file, reading.notes);
  return reading;
}

EulumdatReading read_eulumdat(const std::filesystem::path& file) {
  std::vector<std::string> notes;
  const std::string text = read_photometric_text(file, notes);
  EulumdatReading reading = parse_eulumdat(text, file.string());
  reading.notes.insert(reading.notes.begin(), notes.begin(), notes.end());
  return reading;
}

}  // namespace catoptric::photometry
