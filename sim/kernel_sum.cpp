#include "sim/kernel_sum.h"

#include <array>

#include "base/vector_clones.h"
#include "sim/kernel_shape.h"

namespace catoptric::sim {
namespace {

constexpr std::size_t lanes = KernelSum::lanes;
using Sums = KernelSum::Sums;

/// Photons whose weights are held at a time before they are summed.
constexpr std::size_t block = 16 * lanes;

/// Adds up to `block` numbers to the partial sums.
[[gnu::always_inline]] inline void add_to_parts(const double* numbers, std::size_t count,
                                                std::array<double, lanes>& parts) {
  for (std::size_t i = 0; i < count; i += lanes)
    for (std::size_t lane = 0; lane < lanes; ++lane) parts[lane] += numbers[i + lane];
}

/// The loops over photons: first their weights, then the sums, since each becomes vector code by itself.
/// `square_of(i)` is the squared distance of photon i.
template <Kernel kernel, bool known_within, typename SquareOf>
[[gnu::always_inline]] inline void add_weights(std::size_t count, double square, Sums& sums,
                                               const SquareOf& square_of) {
  const double scale = 1 / square;
  alignas(64) double weights[block], squares[block], counted[block];
  for (std::size_t first = 0; first < count; first += block) {
    const std::size_t length = count - first < block ? count - first : block;
    for (std::size_t i = 0; i < length; ++i) {
      const double squared = square_of(first + i), t_squared = squared * scale;
      const bool counts = known_within | (squared < square);
      const double value = kernel_of_square<kernel>(t_squared < 1 ? t_squared : 1.0);
      const double weight = counts ? value : 0.0;
      weights[i] = weight;
      squares[i] = weight * weight;
      counted[i] = counts ? 1.0 : 0.0;
    }
    const std::size_t whole = (length + lanes - 1) / lanes * lanes;
    for (std::size_t i = length; i < whole; ++i) weights[i] = squares[i] = counted[i] = 0;
    add_to_parts(weights, whole, sums.weight);
    add_to_parts(squares, whole, sums.weight_squared);
    add_to_parts(counted, whole, sums.photons);
  }
}

struct Centre {
  double x, y, square;
};

CATOPTRIC_VECTOR_CLONES
void add_points(Kernel kernel, const Centre& at, const double* __restrict x, const double* __restrict y,
                std::size_t count, Sums& sums) {
  Sums own = sums;
  const Centre centre = at;
  const auto square_of = [=](std::size_t i) __attribute__((always_inline)) {
    const double dx = x[i] - centre.x, dy = y[i] - centre.y;
    return dx * dx + dy * dy;
  };
  with_kernel(
      kernel, [&]<Kernel k>() __attribute__((always_inline)) {
        add_weights<k, false>(count, centre.square, own, square_of);
      });
  sums = own;
}

CATOPTRIC_VECTOR_CLONES
void add_known(Kernel kernel, double square, const double* __restrict known, std::size_t count, Sums& sums) {
  Sums own = sums;
  const auto square_of = [=](std::size_t i) __attribute__((always_inline)) { return known[i]; };
  with_kernel(
      kernel, [&]<Kernel k>()
                  __attribute__((always_inline)) { add_weights<k, true>(count, square, own, square_of); });
  sums = own;
}

}  // namespace

void KernelSum::add(const double* x_mm, const double* y_mm, std::size_t count) {
  add_points(kernel_, {x_mm_, y_mm_, square_mm2_}, x_mm, y_mm, count, sums_);
}

void KernelSum::add_squares(const double* squares_mm2, std::size_t count) {
  add_known(kernel_, square_mm2_, squares_mm2, count, sums_);
}

std::size_t KernelSum::photons() const { return static_cast<std::size_t>(joined(sums_.photons)); }

double KernelSum::joined(const std::array<double, lanes>& parts) {
  double sum = 0;
  for (double part : parts) sum += part;
  return sum;
}

}  // namespace catoptric::sim
