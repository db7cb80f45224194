#pragma once

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <cstddef>
#include <vector>

namespace catoptric::test {

/// How rarely a right program may fail all statistical tests of a room together.
inline constexpr double overall_false_alarm = 1e-6;

/// The level for each of `tests` so that together they give a false alarm with overall_false_alarm at most.
/// @from Sidak 1967
inline double sidak_level(std::size_t tests) {
  return -std::expm1(std::log1p(-overall_false_alarm) / static_cast<double>(tests));
}

/// A generous bound on the number of statistical checks in the room's tests.
inline const double level = sidak_level(200);

/// Probability that a chi-square variable exceeds `value`.
inline double chi_square_tail(double value, std::size_t degrees) {
  return boost::math::cdf(
      boost::math::complement(boost::math::chi_squared(static_cast<double>(degrees)), value));
}

/// p-value of counts against expected counts (all given, one constraint: the total).
inline double chi_square_p(const std::vector<double>& counts, const std::vector<double>& expected) {
  double sum = 0;
  for (std::size_t i = 0; i < counts.size(); ++i)
    sum += (counts[i] - expected[i]) * (counts[i] - expected[i]) / expected[i];
  return chi_square_tail(sum, counts.size() - 1);
}

/// Counts against equal probability.
inline double chi_square_even_p(const std::vector<double>& counts) {
  double total = 0;
  for (double count : counts) total += count;
  return chi_square_p(counts, std::vector<double>(counts.size(), total / static_cast<double>(counts.size())));
}

/// Two-sided p-value of a standard normal variable.
inline double normal_p(double z) {
  return 2 * boost::math::cdf(boost::math::complement(boost::math::normal(), std::abs(z)));
}

/// p-value of independent estimates against their expectations, in units of the reported noise.
inline double z_test_p(const std::vector<double>& values, const std::vector<double>& expected,
                       const std::vector<double>& noise) {
  double sum = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double z = (values[i] - expected[i]) / noise[i];
    sum += z * z;
  }
  return chi_square_tail(sum, values.size());
}

}  // namespace catoptric::test
