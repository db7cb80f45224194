#include "base/spline_basis.h"

#include <algorithm>

#include "base/contract.h"

namespace catoptric {

SplineBasis spline_basis(int degree, std::span<const double> knots, double u) {
  CATOPTRIC_EXPECTS(degree >= 1 && knots.size() >= 2 * static_cast<std::size_t>(degree) + 2);
  const std::size_t p = static_cast<std::size_t>(degree), points = knots.size() - p - 1;
  CATOPTRIC_EXPECTS(u >= knots[p] && u <= knots[points]);
  // The last span with room that begins at or before u.
  std::size_t span = points - 1;
  while (span > p && (u < knots[span] || knots[span] == knots[span + 1])) --span;
  SplineBasis basis{span - p, std::vector<double>(p + 1, 0.0), std::vector<double>(p + 1, 0.0)};
  std::vector<double> lower;  // basis functions of one degree less
  basis.value[0] = 1;
  for (std::size_t j = 1; j <= p; ++j) {
    if (j == p) lower.assign(basis.value.begin(), basis.value.begin() + static_cast<std::ptrdiff_t>(p));
    double saved = 0;
    for (std::size_t i = 0; i < j; ++i) {
      const double right = knots[span + i + 1] - u, left = u - knots[span + 1 - j + i];
      const double share = basis.value[i] / (right + left);
      basis.value[i] = saved + right * share;
      saved = left * share;
    }
    basis.value[j] = saved;
  }
  for (std::size_t i = 0; i <= p; ++i) {
    const auto width = [&](std::size_t k) { return knots[k + p] - knots[k]; };
    const double before = i > 0 ? lower[i - 1] / width(basis.first + i) : 0.0;
    const double after = i < p ? lower[i] / width(basis.first + i + 1) : 0.0;
    basis.slope[i] = static_cast<double>(degree) * (before - after);
  }
  return basis;
}

}  // namespace catoptric
