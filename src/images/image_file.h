#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "images/grey_image.h"

namespace catoptric::images {

/// Reads a grey picture, its format by what stands in the file: PNG (1 to 16 bits, interlaced or not), PGM
/// (P2, P5) or PFM (Pf, both byte orders).
/// @fails InputError with file, place and rule: for colour and transparency, which no rule turns into light;
///        more than most_pixels; a file that is damaged, too short or too long; a value that is negative, not
///        finite or above the file's own greatest, with row and column, counted from 1 at the top left
GreyImage read_image(const std::filesystem::path& file);
/// @in    bytes: of the file; name: for messages
GreyImage parse_image(std::string_view bytes, const std::string& name);

/// Each format by itself.
GreyImage parse_png(std::string_view bytes, const std::string& name);
GreyImage parse_pgm(std::string_view bytes, const std::string& name);
GreyImage parse_pfm(std::string_view bytes, const std::string& name);

}  // namespace catoptric::images
