#pragma once

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <cstddef>
#include <ostream>
#include <stdexcept>
#include <vector>

namespace catoptric::test {

/// How rarely a right program may fail the statistical tests of a room, all together, when its random numbers
/// change. (While they do not, tests repeat to the bit.)
inline constexpr double overall_false_alarm = 1e-4;

/// Most statistical checks that a room's tests make; a run that makes more fails.
inline constexpr std::size_t checks_of_a_room = 300;

/// The level for each of `tests` so that together they give a false alarm with overall_false_alarm at most.
/// @from Sidak 1967
inline double sidak_level(std::size_t tests) {
  return -std::expm1(std::log1p(-overall_false_alarm) / static_cast<double>(tests));
}
inline const double level = sidak_level(checks_of_a_room);

/// Checks that have been made in this process.
inline std::size_t checks_made = 0;

/// What a test says of its p-value, for CHECK, which shows it.
struct Verdict {
  bool holds;
  double p;
  explicit operator bool() const { return holds; }
  friend std::ostream& operator<<(std::ostream& out, const Verdict& verdict) {
    return out << "p = " << verdict.p << " (level " << level << ")";
  }
};

/// Whether chance alone gives such a deviation often enough, all checks of the room taken together.
inline Verdict plausible(double p) {
  if (++checks_made > checks_of_a_room)
    throw std::logic_error(
        "more statistical checks than the level of each allows for: raise checks_of_a_room");
  return {p > level, p};
}

/// Whether a test has found out its wrong twin. Not counted: it is no false alarm that it risks.
inline Verdict rejected(double p) { return {p < level, p}; }

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

/// Two-sided p-value of so many successes in independent trials, exact.
/// @from Clopper & Pearson 1934
inline double binomial_p(std::size_t successes, std::size_t trials, double probability) {
  const boost::math::binomial law(static_cast<double>(trials), probability);
  const double up_to = boost::math::cdf(law, static_cast<double>(successes));
  const double from = 1 - (successes > 0 ? boost::math::cdf(law, static_cast<double>(successes - 1)) : 0);
  return std::min(1.0, 2 * std::min(up_to, from));
}

/// Two-sided p-value of a sample variance over its expectation, of normal values.
inline double variance_ratio_p(double ratio, std::size_t degrees) {
  const double above = chi_square_tail(ratio * static_cast<double>(degrees), degrees);
  return 2 * std::min(above, 1 - above);
}

/// Two-sided p-value of the mean of independent sets being what is wanted.  @from Student 1908
inline double student_p(const std::vector<double>& sets, double wanted) {
  const auto n = static_cast<double>(sets.size());
  double mean = 0, square = 0;
  for (const double x : sets) mean += x / n;
  for (const double x : sets) square += (x - mean) * (x - mean);
  const double t = std::abs(mean - wanted) / std::sqrt(square / (n - 1) / n);
  return 2 * boost::math::cdf(boost::math::complement(boost::math::students_t(n - 1), t));
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
