#include "sim/kernel.h"

#include <boost/math/quadrature/gauss.hpp>
#include <catch2/catch.hpp>
#include <limits>

using namespace catoptric::sim;

namespace {

const auto all = {Kernel::silverman, Kernel::epanechnikov, Kernel::cone, Kernel::gaussian, Kernel::constant};

template <typename Function>
double mean_over_disc(const Function& function) {
  return boost::math::quadrature::gauss<double, 30>::integrate([&](double t) { return 2 * t * function(t); },
                                                               0.0, 1.0);
}

}  // namespace

TEST_CASE("every kernel has mean 1 over its disc, and the stated mean square") {
  for (Kernel kernel : all) {
    CAPTURE(name(kernel));
    CHECK(mean_over_disc([=](double t) { return kernel_value(kernel, t); }) == Approx(1).epsilon(1e-13));
    CHECK(mean_over_disc([=](double t) { return kernel_value(kernel, t) * kernel_value(kernel, t); }) ==
          Approx(kernel_square_mean(kernel)).epsilon(1e-13));
  }
}

TEST_CASE("kernels have the shapes of their formulas and end at the radius") {
  CHECK(kernel_value(Kernel::silverman, 0.5) == Approx(3 * 0.75 * 0.75));
  CHECK(kernel_value(Kernel::epanechnikov, 0.5) == Approx(1.5));
  CHECK(kernel_value(Kernel::cone, 0.25) == Approx(2.25));
  CHECK(kernel_value(Kernel::constant, 0.9) == 1);
  CHECK(kernel_value(Kernel::gaussian, 1.0 / 3) / kernel_value(Kernel::gaussian, 0) ==
        Approx(std::exp(-0.5)));
  for (Kernel kernel : all) {
    CHECK(kernel_value(kernel, 1.0000001) == 0);
    CHECK(kernel_value(kernel, -0.1) == 0);
    CHECK(kernel_value(kernel, std::numeric_limits<double>::quiet_NaN()) == 0);
  }
}

TEST_CASE("kernel names go both ways") {
  for (Kernel kernel : all) CHECK(parse_kernel(name(kernel)) == kernel);
  CHECK_FALSE(parse_kernel("Silverman "));
  CHECK_FALSE(parse_kernel(""));
}
