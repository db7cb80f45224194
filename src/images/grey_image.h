#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace catoptric::images {

/// Most pixels that are taken: 268 MB as numbers. A near field has a million samples at most.
inline constexpr std::size_t most_pixels = std::size_t{1} << 25;
/// Greatest number of columns or rows.
inline constexpr std::size_t longest_side = std::size_t{1} << 20;

/// A grey picture as its file has it: PNG and PGM count from black, 0, to white, 1, and PFM holds numbers.
struct GreyImage {
  std::string format;  ///< "PNG", "PGM" or "PFM"
  std::size_t columns = 0, rows = 0;
  std::vector<double> values;  ///< row by row from the top, each from the left; finite, at least 0
  bool has_white = false;      ///< PNG, PGM: 1 is white. PFM: no value is greatest
  /// PNG: what the file says of how grey stands for light; nothing where it says nothing.
  std::optional<double> stated_gamma;  ///< light goes like grey to this power
  bool is_srgb = false;                ///< or by sRGB's own curve
  bool has_profile = false;            ///< or by an ICC profile, which is not read
  double stated_factor = 1;            ///< PFM: that of its third line, which the values have been given

  double value(std::size_t row, std::size_t column) const { return values[row * columns + column]; }
};

}  // namespace catoptric::images
