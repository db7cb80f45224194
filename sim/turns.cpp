#include "sim/turns.h"

#include "base/contract.h"
#include "base/units.h"
#include "base/vector_clones.h"

namespace catoptric::sim {
namespace {

/// Taylor's series up to the angle's 17th power: within an eighth of a turn the next term is below 1e-19.
[[gnu::always_inline]] inline double sine_of_small(double a) {
  const double s = a * a;
  double sum = 1.0 / 355687428096000;
  sum = sum * s - 1.0 / 1307674368000;
  sum = sum * s + 1.0 / 6227020800;
  sum = sum * s - 1.0 / 39916800;
  sum = sum * s + 1.0 / 362880;
  sum = sum * s - 1.0 / 5040;
  sum = sum * s + 1.0 / 120;
  sum = sum * s - 1.0 / 6;
  return a + a * s * sum;
}

[[gnu::always_inline]] inline double cosine_of_small(double a) {
  const double s = a * a;
  double sum = 1.0 / 20922789888000;
  sum = sum * s - 1.0 / 87178291200;
  sum = sum * s + 1.0 / 479001600;
  sum = sum * s - 1.0 / 3628800;
  sum = sum * s + 1.0 / 40320;
  sum = sum * s - 1.0 / 720;
  sum = sum * s + 1.0 / 24;
  return 1 - (0.5 * s - s * s * sum);
}

CATOPTRIC_VECTOR_CLONES
void fill(std::size_t count, const double* __restrict turns, double* __restrict cosines,
          double* __restrict sines) {
  constexpr double no_fraction = 0x1.8p52;  // a double of this size keeps no digits behind the point
  for (std::size_t i = 0; i < count; ++i) {
    const double quarter = (4 * turns[i] + no_fraction) - no_fraction;
    const double angle = 2 * pi * (turns[i] - 0.25 * quarter);
    const double sine = sine_of_small(angle), cosine = cosine_of_small(angle);
    const bool odd = (quarter == 1) | (quarter == 3);
    const double x = odd ? sine : cosine, y = odd ? cosine : sine;
    cosines[i] = (quarter == 1) | (quarter == 2) ? -x : x;
    sines[i] = (quarter == 2) | (quarter == 3) ? -y : y;
  }
}

}  // namespace

void cosines_and_sines(std::span<const double> turns, std::span<double> cosines, std::span<double> sines) {
  CATOPTRIC_EXPECTS(cosines.size() == turns.size() && sines.size() == turns.size());
  fill(turns.size(), turns.data(), cosines.data(), sines.data());
}

}  // namespace catoptric::sim
