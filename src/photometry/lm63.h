#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/intensity_table.h"
#include "photometry/luminaire.h"

namespace catoptric::photometry {

/// Which edition of IES LM-63 a file follows; its first line says so, but for the first edition.
enum class Lm63Version { of_1986, of_1991, of_1995, of_2002, of_2019 };

/// The first line of files of that edition; empty for 1986.
std::string_view first_line(Lm63Version version);

/// Which sphere the angles belong to; the numbers are the file's.
enum class PhotometricType { c = 1, b = 2, a = 3 };

enum class Lm63Units { feet = 1, metres = 2 };

/// `[NAME] value`; what [MORE] adds stands behind a line feed. Labels of 1986 have no name.
struct Lm63Keyword {
  std::string name;
  std::string value;
  bool operator==(const Lm63Keyword&) const = default;
};

/// How the lamp's flux depends on how the luminaire is tilted.
struct Lm63Tilt {
  int lamp_geometry = 1;  ///< 1 to 3, as in the standard
  std::vector<double> angles_deg;
  std::vector<double> factors;
  bool operator==(const Lm63Tilt&) const = default;
};

/// Code of 2019 in the place of the ballast-lamp factor: the file comes from a computer simulation.
inline constexpr double simulated_file_code = 1.00010;

/// An IES file as it stands: its own units, type, angles and factors.
struct Lm63File {
  Lm63Version version = Lm63Version::of_2019;
  std::vector<Lm63Keyword> keywords;
  std::optional<Lm63Tilt> tilt;
  int lamp_count = 1;
  std::optional<double> lumens_per_lamp;  ///< none: absolute photometry
  double multiplier = 1;                  ///< of the candela values, linear
  PhotometricType type = PhotometricType::c;
  Lm63Units units = Lm63Units::metres;
  double width = 0, length = 0, height = 0;  ///< of the luminous opening; below 0: rounded
  double ballast_factor = 1;
  double ballast_lamp_factor = 1;  ///< in 2019 the code of how the file came about, which is no factor
  double input_w = 0;
  std::vector<double> vertical_deg, horizontal_deg;
  std::vector<double> candela;  ///< shape (horizontal, vertical), as written: no factor is applied

  bool operator==(const Lm63File&) const = default;
};

struct Lm63Reading {
  Lm63File file;
  std::vector<std::string> notes;  ///< what was accepted although the standard has it otherwise
};

/// Reads an IES file. TILT may name a file in the same folder.
/// @fails InputError with file, line, field, rule
Lm63Reading read_lm63(const std::filesystem::path& file);

/// The same from text.
/// @in    name: for messages; folder: where a file that TILT names may stand, nowhere when empty
Lm63Reading parse_lm63(std::string_view bytes, const std::string& name,
                       const std::filesystem::path& folder = {});

/// Product of all factors on the candela values.
double candela_factor(const Lm63File& file);

/// Intensity in cd, all factors applied, symmetric planes spread over the full turn. Of types A and B the
/// direction (0, 0) becomes gamma = 0, horizontal angles count towards C = 0, vertical ones towards C = 90;
/// what lies beyond their angles is dark.
/// @error none for type C. Types A and B are resampled with their own finest step (0.25 to 5 degrees), h: off
///        by h^2 / 8 times the second derivatives at most, and by the jump at the edge of what was measured
IntensityTable intensity_of(const Lm63File& file);

/// The luminous opening in mm. Length lies in the plane C0-C180, width in C90-C270.
LuminousOpening opening_of(const Lm63File& file);

/// An IES file of this luminaire: type C, absolute photometry or the lamps' lumens, metres, all factors 1.
/// @in    version: 2002 or 2019; 2019 says that the file comes from a computer simulation
/// @fails InputError when the table is no candela, or the version another
Lm63File lm63_of(const IntensityTable& table, const Luminaire& luminaire,
                 Lm63Version version = Lm63Version::of_2019);

/// The file's text, with CR LF; what it says is read back to the same bits. Texts longer than a line go on
/// behind [MORE].
std::string lm63_text(const Lm63File& file);

}  // namespace catoptric::photometry
