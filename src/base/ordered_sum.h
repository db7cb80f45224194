#pragma once

#include <cmath>
#include <cstddef>
#include <span>

namespace catoptric {

/// Sum in index order by halves, so that the result depends on the order alone and rounding grows like log n.
/// @error relative to the sum of magnitudes: about log2(n) roundings
/// @from  Higham, Accuracy and Stability of Numerical Algorithms, 2nd ed., section 4.2
inline double ordered_sum(std::span<const double> values) {
  constexpr std::size_t block = 32;
  if (values.size() <= block) {
    double sum = 0;
    for (double value : values) sum += value;
    return sum;
  }
  const std::size_t half = values.size() / 2;
  return ordered_sum(values.first(half)) + ordered_sum(values.subspan(half));
}

/// Running sum with compensation, for a stream whose length is not known.
/// @error one rounding of the result plus n eps^2 of the sum of magnitudes
/// @from  Neumaier 1974
class CompensatedSum {
 public:
  void add(double value) {
    const double next = sum_ + value;
    correction_ += std::abs(sum_) >= std::abs(value) ? (sum_ - next) + value : (value - next) + sum_;
    sum_ = next;
  }
  double value() const { return sum_ + correction_; }

 private:
  double sum_ = 0;
  double correction_ = 0;
};

}  // namespace catoptric
