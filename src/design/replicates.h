#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace catoptric::design {

/// A figure with what is known of its error: the truth lies near value - bias.
struct Figure {
  double value = 0;  ///< mean over replicates of the figure as one evaluation gives it
  double noise = 0;  ///< standard error of `value`, from the replicates' spread
  double bias = 0;   ///< estimated systematic part of `value`: photon noise that counts as error or makes
                     ///< extremes more extreme, and the kernel's blur
  std::optional<double> half_interval;  ///< value - bias give or take this holds the truth with a probability
                                        ///< of 95 %; nothing where too few replicates show a spread
};

/// Numbers of each replicate, all rows of one length.
using Rows = std::vector<std::vector<double>>;

/// Mean and variance of the mean, number by number, over replicates; one replicate has no variance.
struct Spread {
  std::vector<double> mean, variance_of_mean;
};

inline constexpr std::size_t none_left_out = static_cast<std::size_t>(-1);

/// @in left_out: the replicate not counted, or none_left_out
Spread spread(const Rows& rows, std::size_t left_out = none_left_out);

/// Half width, in standard errors, of an interval that holds the truth with a probability of 95 %.
double student95(std::size_t replicates);

/// How far noise may move the least and the greatest of a field beyond what the spread of one place shows:
/// among places that noise cannot tell apart it picks the one where it is worst.
/// @from  of m normal errors the largest lies below sqrt(2 ln m) standard deviations on average
struct ExtremesMargin {
  double least = 0, greatest = 0;  ///< 0 where one place stands out
};
ExtremesMargin extremes_margin(const Spread& fields);

/// What replicates say of numbers that follow from a field.
/// @in    of_one: the numbers as one evaluation's field, as the kernel shows it, gives them; of_all: the same
///        free of noise and blur as far as can be, from the spread of the fields without blur
/// @from  noise: spread of replicates, Student's t; interval: jackknife over the replicates (Miller 1974)
std::vector<Figure> figures_of(const Rows& reflected, const Rows& sharp,
                               const std::function<std::vector<double>(const std::vector<double>&)>& of_one,
                               const std::function<std::vector<double>(const Spread&)>& of_all);

}  // namespace catoptric::design
