#pragma once

#include <boost/math/quadrature/gauss.hpp>

namespace catoptric::test {

/// Gauss-Legendre with 15 points on each of equal parts.
template <typename F>
double integral(double from, double to, int parts, const F& f) {
  double sum = 0;
  for (int i = 0; i < parts; ++i)
    sum += boost::math::quadrature::gauss<double, 15>::integrate(f, from + (to - from) * i / parts,
                                                                 from + (to - from) * (i + 1) / parts);
  return sum;
}

}  // namespace catoptric::test
