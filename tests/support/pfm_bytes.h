#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <vector>

namespace catoptric::test {

/// A PFM of these rows, from the top.
/// @in    factor: the third line; negative: the least byte comes first
inline std::string pfm_bytes(const std::vector<std::vector<float>>& rows, const std::string& factor) {
  std::string text =
      "Pf\n" + std::to_string(rows.front().size()) + " " + std::to_string(rows.size()) + "\n" + factor + "\n";
  const bool least_first = factor.starts_with('-');
  for (auto row = rows.rbegin(); row != rows.rend(); ++row)
    for (const float value : *row) {
      const auto bits = std::bit_cast<std::uint32_t>(value);
      for (int i = 0; i < 4; ++i) text += static_cast<char>((bits >> (8 * (least_first ? i : 3 - i))) & 255u);
    }
  return text;
}

}  // namespace catoptric::test
