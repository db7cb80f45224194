#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/intensity_table.h"
#include "photometry/luminaire.h"

namespace catoptric::photometry {

enum class PhotometricFormat { lm63, eulumdat };

/// What a photometric file holds for whoever wants its light.
struct MeasuredIntensity {
  IntensityTable table;                ///< cd, all of the file's factors applied
  std::optional<double> lamp_flux_lm;  ///< of all lamps; none: absolute photometry
  double input_w = 0;
  LuminousOpening opening;
  std::vector<std::string> notes;  ///< sentences: what was accepted although the format has it otherwise
};

/// The format, by what stands in the file; when that leaves it open by the ending .ies or .ldt.
/// @fails InputError when both leave it open
PhotometricFormat format_of(std::string_view text, const std::filesystem::path& file);

/// Reads an IES or a EULUMDAT file.
/// @fails InputError with file, line, field, rule
MeasuredIntensity read_intensity(const std::filesystem::path& file);

/// Writes the table in the format of the file's ending, .ies (LM-63-2019) or .ldt, whole or not at all.
/// @fails InputError for another ending or what the format does not hold; IoError
void write_intensity(const std::filesystem::path& file, const IntensityTable& table,
                     const Luminaire& luminaire);

}  // namespace catoptric::photometry
