#include "photometry/direct_ratio.h"

#include <algorithm>
#include <cmath>

#include "base/ordered_sum.h"
#include "base/units.h"

namespace catoptric::photometry {

double direct_ratio(const IntensityTable& table, double room_index) {
  constexpr int gamma_steps = 180, c_steps = 120;  // of 90 and of 360 degrees
  constexpr double degree = pi / 180;
  CompensatedSum caught, all;
  for (int i = 0; i < gamma_steps; ++i) {
    const double gamma = (i + 0.5) * 90 / gamma_steps;
    const double reach = std::tan(gamma * degree) / (2 * room_index);
    for (int j = 0; j < c_steps; ++j) {
      const double c = (j + 0.5) * 360 / c_steps;
      const double flux = table.at(gamma, c) * std::sin(gamma * degree);
      all.add(flux);
      caught.add(flux * std::max(0.0, 1 - reach * std::abs(std::cos(c * degree))) *
                 std::max(0.0, 1 - reach * std::abs(std::sin(c * degree))));
    }
  }
  return all.value() > 0 ? caught.value() / all.value() : 0;
}

}  // namespace catoptric::photometry
