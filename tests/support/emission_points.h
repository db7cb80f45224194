#pragma once

#include <array>
#include <span>
#include <vector>

#include "sim/emission.h"

namespace catoptric::test {

/// All the numbers of photons first, first + 1, ..., photon by photon.
inline std::vector<std::array<double, sim::most_emission_numbers>> emission_points(sim::Sampler sampler,
                                                                                   std::uint64_t key,
                                                                                   std::uint64_t first,
                                                                                   std::size_t count) {
  std::array<std::vector<double>, sim::most_emission_numbers> rows;
  std::array<std::span<double>, sim::most_emission_numbers> spans;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    rows[row].resize(count);
    spans[row] = rows[row];
  }
  sim::EmissionNumbers(sampler, key).draw(first, spans);
  std::vector<std::array<double, sim::most_emission_numbers>> points(count);
  for (std::size_t row = 0; row < rows.size(); ++row)
    for (std::size_t i = 0; i < count; ++i) points[i][row] = rows[row][i];
  return points;
}

}  // namespace catoptric::test
