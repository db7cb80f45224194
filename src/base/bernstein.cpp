#include "base/bernstein.h"

#include <algorithm>

#include "base/contract.h"

namespace catoptric {

double bernstein_value(std::span<const double> coefficients, double s) {
  std::vector<double> work(coefficients.begin(), coefficients.end());
  for (std::size_t level = work.size(); level-- > 1;)
    for (std::size_t i = 0; i < level; ++i) work[i] = (1 - s) * work[i] + s * work[i + 1];
  return work.front();
}

void bernstein_split(std::span<const double> coefficients, double s, std::vector<double>& left,
                     std::vector<double>& right) {
  right.assign(coefficients.begin(), coefficients.end());
  left.resize(right.size());
  left[0] = right[0];
  for (std::size_t level = 1; level < right.size(); ++level) {
    for (std::size_t i = 0; i + level < right.size(); ++i) right[i] = (1 - s) * right[i] + s * right[i + 1];
    left[level] = right[0];
  }
}

double binomial(int n, int k) {
  CATOPTRIC_EXPECTS(n >= 0 && k >= 0 && k <= n);
  double value = 1;
  for (int i = 1; i <= std::min(k, n - k); ++i) value = value * (n - i + 1) / i;
  return value;
}

std::vector<double> bernstein_product(std::span<const double> a, std::span<const double> b) {
  const int m = static_cast<int>(a.size()) - 1;
  const int n = static_cast<int>(b.size()) - 1;
  std::vector<double> product(static_cast<std::size_t>(m + n + 1), 0.0);
  for (int i = 0; i <= m; ++i)
    for (int j = 0; j <= n; ++j)
      product[static_cast<std::size_t>(i + j)] += binomial(m, i) * binomial(n, j) / binomial(m + n, i + j) *
                                                  a[static_cast<std::size_t>(i)] *
                                                  b[static_cast<std::size_t>(j)];
  return product;
}

}  // namespace catoptric
