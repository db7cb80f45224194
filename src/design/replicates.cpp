#include "design/replicates.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

namespace catoptric::design {

Spread spread(const Rows& rows, std::size_t left_out) {
  const std::size_t count = rows.front().size();
  const double n = static_cast<double>(rows.size() - (left_out == none_left_out ? 0 : 1));
  Spread result{std::vector<double>(count, 0.0), std::vector<double>(count, 0.0)};
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t j = 0; i != left_out && j < count; ++j) result.mean[j] += rows[i][j] / n;
  for (std::size_t i = 0; n > 1 && i < rows.size(); ++i)
    for (std::size_t j = 0; i != left_out && j < count; ++j) {
      const double off = rows[i][j] - result.mean[j];
      result.variance_of_mean[j] += off * off / (n * (n - 1));
    }
  return result;
}

double student95(std::size_t replicates) {
  if (replicates < 2) return 0;
  const boost::math::students_t student(static_cast<double>(replicates - 1));
  return boost::math::quantile(boost::math::complement(student, 0.025));
}

namespace {

/// For the places whose value lies within reach of the extreme one.
double margin_of(const Spread& fields, double extreme, double reach) {
  double variance = 0;
  std::size_t rivals = 0;
  for (std::size_t i = 0; i < fields.mean.size(); ++i) {
    if (!(std::abs(fields.mean[i] - extreme) <= reach)) continue;
    variance += fields.variance_of_mean[i];
    ++rivals;
  }
  const double count = static_cast<double>(rivals);
  return std::sqrt(variance / count * 2 * std::log(count));
}

}  // namespace

ExtremesMargin extremes_margin(const Spread& fields) {
  const double count = static_cast<double>(fields.mean.size());
  double variance = 0;
  for (const double each : fields.variance_of_mean) variance += each / count;
  // The extreme one and its rival may be off by that much each.
  const double reach = 2 * std::sqrt(variance * 2 * std::log(count));
  const auto [least, greatest] = std::minmax_element(fields.mean.begin(), fields.mean.end());
  return {margin_of(fields, *least, reach), margin_of(fields, *greatest, reach)};
}

std::vector<Figure> figures_of(const Rows& reflected, const Rows& sharp,
                               const std::function<std::vector<double>(const std::vector<double>&)>& of_one,
                               const std::function<std::vector<double>(const Spread&)>& of_all) {
  Rows values;
  for (const auto& field : reflected) values.push_back(of_one(field));
  const Spread value = spread(values);
  const std::vector<double> clean = of_all(spread(sharp));
  std::vector<Figure> figures;
  for (std::size_t k = 0; k < clean.size(); ++k) {
    Figure figure{value.mean[k], std::sqrt(value.variance_of_mean[k]), value.mean[k] - clean[k], {}};
    if (sharp.size() == 1) figure.half_interval = 0;  // tubes: nothing is random
    figures.push_back(figure);
  }
  if (sharp.size() < 3) return figures;  // without one of two there is no noise left to take off
  Rows without;
  for (std::size_t i = 0; i < sharp.size(); ++i) without.push_back(of_all(spread(sharp, i)));
  const Spread jackknife = spread(without);
  const double shrunk = static_cast<double>(sharp.size() - 1);  // what leaving one out hides of the spread
  for (std::size_t k = 0; k < figures.size(); ++k)
    figures[k].half_interval = student95(sharp.size()) * shrunk * std::sqrt(jackknife.variance_of_mean[k]);
  return figures;
}

}  // namespace catoptric::design
