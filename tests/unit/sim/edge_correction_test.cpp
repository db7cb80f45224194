#include "sim/edge_correction.h"

#include <catch2/catch.hpp>

#include "base/units.h"

using namespace catoptric;
using namespace catoptric::sim;
using Shape = NearField::Shape;

namespace {

const auto all = {Kernel::silverman, Kernel::epanechnikov, Kernel::cone, Kernel::gaussian, Kernel::constant};

/// The same share by brute force on a grid of equal-area cells of the kernel's disc.
double counted_mass(Kernel kernel, double radius, const RecordedArea& area, const Vector2& at) {
  constexpr int rings = 800, azimuths = 800;
  double inside = 0, whole = 0;
  for (int i = 0; i < rings; ++i) {
    const double t = std::sqrt((i + 0.5) / rings);
    const double weight = kernel_value(kernel, t);
    for (int j = 0; j < azimuths; ++j) {
      const double angle = 2 * pi * (j + 0.5) / azimuths;
      whole += weight;
      if (area.contains(at + radius * t * Vector2(std::cos(angle), std::sin(angle)))) inside += weight;
    }
  }
  return inside / whole;
}

}  // namespace

TEST_CASE("away from the edge nothing is corrected") {
  for (Kernel kernel : all) {
    CHECK(kernel_mass_inside(kernel, 4, {Shape::disc, 10, 10}, {6, 0}) == 1);
    CHECK(kernel_mass_inside(kernel, 4, {Shape::rectangle, 10, 5}, {6, -1}) == 1);
  }
}

TEST_CASE("on a straight edge half the kernel is left, in a corner a quarter") {
  for (Kernel kernel : all) {
    CHECK(kernel_mass_inside(kernel, 4, {Shape::rectangle, 10, 10}, {10, 0}) == Approx(0.5).epsilon(1e-12));
    CHECK(kernel_mass_inside(kernel, 4, {Shape::rectangle, 10, 10}, {-10, 10}) ==
          Approx(0.25).epsilon(1e-12));
  }
}

TEST_CASE("a kernel wider than the whole area keeps the area's mass") {
  // constant kernel: area over area
  CHECK(kernel_mass_inside(Kernel::constant, 100, {Shape::disc, 10, 10}, {3, 2}) ==
        Approx(0.01).epsilon(1e-9));
  CHECK(kernel_mass_inside(Kernel::constant, 100, {Shape::rectangle, 10, 5}, {3, 2}) ==
        Approx(200 / (pi * 1e4)).epsilon(1e-9));
  CHECK(kernel_mass_inside(Kernel::silverman, 100, {Shape::disc, 10, 10}, {0, 0}) ==
        Approx(1 - std::pow(1 - 0.01, 3)).epsilon(1e-9));
}

TEST_CASE("the share agrees with counting for every kernel, shape and place", "[long]") {
  const Vector2 places[] = {{0, 0}, {8, 0}, {9.9, 0}, {-6, 7}, {7, -4.9}, {-9.5, 4.5}};
  for (Kernel kernel : all)
    for (const Vector2& at : places)
      for (double radius : {1.0, 5.0, 12.0, 25.0}) {
        const RecordedArea disc{Shape::disc, 10, 10}, rectangle{Shape::rectangle, 10, 5};
        CAPTURE(name(kernel), at.transpose(), radius);
        // counting errs by the cells on the border: 1 in 800 of the disc's circumference
        if (disc.contains(at))
          CHECK(kernel_mass_inside(kernel, radius, disc, at) ==
                Approx(counted_mass(kernel, radius, disc, at)).margin(2e-3));
        if (rectangle.contains(at))
          CHECK(kernel_mass_inside(kernel, radius, rectangle, at) ==
                Approx(counted_mass(kernel, radius, rectangle, at)).margin(2e-3));
      }
}
