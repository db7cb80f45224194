#include "sim/radial_moments.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "base/contract.h"
#include "base/vector_clones.h"

namespace catoptric::sim {
namespace {

constexpr std::size_t block = 64;  ///< photons whose distances are held at a time

struct Scale {
  double x, y, per_mm2;
};

CATOPTRIC_VECTOR_CLONES
void relative_squares(const Scale& at, const double* __restrict x, const double* __restrict y,
                      std::size_t count, double* __restrict squares) {
  const Scale scale = at;
  for (std::size_t i = 0; i < count; ++i) {
    const double dx = x[i] - scale.x, dy = y[i] - scale.y;
    squares[i] = (dx * dx + dy * dy) * scale.per_mm2;
  }
}

}  // namespace

RadialMoments::RadialMoments(double widest_radius_mm, std::size_t levels)
    : radius_mm_(widest_radius_mm),
      per_mm2_(1 / (widest_radius_mm * widest_radius_mm)),
      levels_(levels),
      rings_((levels + 1) * turns) {
  CATOPTRIC_EXPECTS(widest_radius_mm > 0 && levels > 0);
}

void RadialMoments::start(const StoredPhoton& centre) {
  centre_ = centre;
  std::fill(rings_.begin(), rings_.end(), Moments{});
}

void RadialMoments::add(const double* x_mm, const double* y_mm, std::size_t count) {
  double squares[block];
  for (std::size_t first = 0; first < count; first += block) {
    const std::size_t length = std::min(block, count - first);
    relative_squares({centre_.x_mm, centre_.y_mm, per_mm2_}, x_mm + first, y_mm + first, length, squares);
    for (std::size_t i = 0; i < length; ++i) {
      const double t = squares[i];
      // The biased exponent of [1/2, 1) is 1022, of each halving one less; 1 and more lie beyond the radius.
      const auto exponent = static_cast<std::int64_t>(std::bit_cast<std::uint64_t>(t) >> 52);
      const auto halving = std::clamp<std::int64_t>(1023 - exponent, 0, static_cast<std::int64_t>(levels_));
      Moments& ring = rings_[static_cast<std::size_t>(halving) * turns + i % turns];
      ring.count += 1;
      ring.sum += t;
      ring.squares += t * t;
    }
  }
}

double RadialMoments::radius_mm(std::size_t level) const {
  return radius_mm_ * std::pow(0.5, 0.5 * static_cast<double>(level));
}

void RadialMoments::weights(std::span<double> by_level) const {
  CATOPTRIC_EXPECTS(by_level.size() == levels_);
  Moments within;
  for (std::size_t level = levels_; level-- > 0;) {
    for (std::size_t turn = 0; turn < turns; ++turn) {
      const Moments& ring = rings_[(level + 1) * turns + turn];
      within.count += ring.count;
      within.sum += ring.sum;
      within.squares += ring.squares;
    }
    const double widening = std::ldexp(1.0, static_cast<int>(level));  // of t for the narrower radius
    // The sum of 3 (1 - t)^2; where all photons lie on the border it may round below 0.
    by_level[level] =
        std::max(0.0, 3 * (within.count - widening * (2 * within.sum - widening * within.squares)));
  }
}

}  // namespace catoptric::sim
