#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/intensity_table.h"
#include "photometry/luminaire.h"

namespace catoptric::photometry {

/// What planes stand for others; the numbers are the file's (Isym).
enum class EulumdatSymmetry { none = 0, rotational = 1, about_c0 = 2, about_c90 = 3, both = 4 };

struct EulumdatLamps {
  int count = 1;  ///< below 0: absolute photometry
  std::string type;
  double flux_lm = 0;  ///< of all lamps of the set together
  std::string colour;
  std::string rendering;
  double input_w = 0;
  bool operator==(const EulumdatLamps&) const = default;
};

/// A EULUMDAT file as it stands, but for intensities, which are cd here and cd/klm in the file.
struct EulumdatFile {
  std::string company, report, luminaire, catalog, file_name, date;
  int type = 3;  ///< Ityp: 0 or 3 point source, 1 with symmetry about its axis, 2 linear
  EulumdatSymmetry symmetry = EulumdatSymmetry::none;
  double length_mm = 0, width_mm = 0, height_mm = 0;     ///< width 0: round
  double luminous_length_mm = 0, luminous_width_mm = 0;  ///< likewise
  std::array<double, 4> luminous_heights_mm{};           ///< at C = 0, 90, 180, 270
  double downward_percent = 0;                           ///< of the luminaire's flux
  double output_ratio_percent = 0;                       ///< luminaire's flux over the lamps'
  double conversion_factor = 1;                          ///< of the intensities
  double tilt_deg = 0;                                   ///< during the measurement
  std::vector<EulumdatLamps> lamps;                      ///< sets the luminaire may have
  std::array<double, 10> direct_ratios{};                ///< rooms of index 0.6 to 5
  std::vector<double> c_deg, gamma_deg;                  ///< all planes, stored or not
  std::vector<double> intensity_cd;  ///< shape (stored planes, gamma), with the first set of lamps

  bool operator==(const EulumdatFile&) const = default;
};

struct EulumdatReading {
  EulumdatFile file;
  std::vector<std::string> notes;  ///< what was accepted although the format has it otherwise
};

/// Reads a EULUMDAT file.
/// @fails InputError with file, line, the line's meaning and the rule
EulumdatReading read_eulumdat(const std::filesystem::path& file);

/// The same from text.  @in name: for messages
EulumdatReading parse_eulumdat(std::string_view bytes, const std::string& name);

/// Which plane of `c_deg` each stored plane is, in the file's order: all, the first, or from C = 0 or 270 on.
std::vector<std::size_t> stored_planes(EulumdatSymmetry symmetry, std::size_t plane_count);

/// Which stored plane holds the values of each plane of `c_deg`.
std::vector<std::size_t> plane_sources(EulumdatSymmetry symmetry, std::size_t plane_count);

/// Intensity in cd; one plane for symmetry about the axis, else all.
/// @error none: no angle is added
IntensityTable intensity_of(const EulumdatFile& file);

/// The luminous area in mm. Length lies in the plane C90-C270, width in C0-C180.
LuminousOpening opening_of(const EulumdatFile& file);

/// Most angles to the axis that the format has room for.
inline constexpr std::size_t most_eulumdat_angles = 361;

/// A EULUMDAT file of this luminaire, with the most symmetry that the table has to the bit, flux fractions
/// and direct ratios computed. Absolute photometry is lamps that give the luminaire's flux, their count < 0.
/// @fails InputError when the table is no candela, dark, or has more angles than the format (721 by 361)
EulumdatFile eulumdat_of(const IntensityTable& table, const Luminaire& luminaire);

/// The file's text, with CR LF; intensities are read back to the same bits.
std::string eulumdat_text(const EulumdatFile& file);

}  // namespace catoptric::photometry
