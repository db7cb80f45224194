#include <catch2/catch.hpp>

#include "base/units.h"
#include "sim/object_shapes.h"

using namespace catoptric;
using namespace catoptric::sim;

namespace {

/// Whether a surface is met at a point, from either side.
bool is_on(const SurfaceShape& shape, const Vector3& point_mm, const Vector3& normal) {
  constexpr double away_mm = 0.1, near_mm = 1e-6;
  for (const double side : {-1.0, 1.0}) {
    const auto met = shape.meet({point_mm + side * away_mm * normal, -side * normal}, false, 1);
    if (met && std::abs(met->distance_mm - away_mm) < near_mm) return true;
  }
  return false;
}

/// A point a hair towards the middle, off the border.
Vector3 inwards(const Vector3& point_mm, const Vector3& middle_mm) {
  return point_mm + 1e-7 * (middle_mm - point_mm);
}

}  // namespace

TEST_CASE("lines that show a shape lie on it and go to its ends") {
  const Vector3 centre(3, -2, 7), axis = Vector3(1, 2, 2).normalized();
  double farthest = 0;
  for (const auto& line : make_disc(centre, axis, 5, 2)->outlines())
    for (const Vector3& point : line) {
      CHECK(std::abs((point - centre).dot(axis)) < 1e-12);
      farthest = std::max(farthest, (point - centre).norm());
      CHECK(((point - centre).norm() == Approx(5) || (point - centre).norm() == Approx(2)));
    }
  CHECK(farthest == Approx(5));

  const auto rectangle = make_rectangle(centre, axis, Vector3::UnitX(), 4, 6);
  const auto border = rectangle->outlines();
  REQUIRE(border.size() == 1);
  for (const Vector3& point : border.front()) {
    CHECK((point - centre).norm() == Approx(std::sqrt(13.0)));
    CHECK(is_on(*rectangle, inwards(point, centre), axis));
  }

  const auto tube = make_tube(centre, axis, 5, 8);
  double top = 0;
  for (const auto& line : tube->outlines())
    for (const Vector3& point : line) {
      const double height = (point - centre).dot(axis);
      const Vector3 out = (point - centre - height * axis).normalized();
      top = std::max(top, height);
      CHECK(is_on(*tube, point - 1e-7 * height * axis, out));
    }
  CHECK(top == Approx(4));

  for (const double half : {0.4, pi / 2, 2.5, pi}) {
    const auto cap = make_cap(centre, axis, 5, half);
    double least_cosine = 1;
    for (const auto& line : cap->outlines())
      for (const Vector3& point : line) {
        const Vector3 out = (point - centre) / 5;
        CHECK(out.norm() == Approx(1));
        least_cosine = std::min(least_cosine, out.dot(axis));
        CHECK(is_on(*cap, centre + 5 * (out + 1e-7 * axis).normalized(), out));
      }
    CHECK(least_cosine == Approx(std::cos(half)).margin(1e-9));
  }
}
