#include "sim/near_field.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "base/units.h"

using namespace catoptric;
using namespace catoptric::sim;

TEST_CASE("a near field looking up keeps x and y") {
  const auto field = NearField::disc({1, 2, 3}, {0, 0, 7}, 50);
  CHECK(field.normal() == Vector3(0, 0, 1));
  CHECK(field.to_plane({5, 8, 99}) == Vector2(4, 6));
  CHECK(field.to_space({4, 6}) == Vector3(5, 8, 3));
  CHECK(field.area_mm2() == Approx(pi * 2500));
}

TEST_CASE("axes are right-handed and unit for any tilt, and plane coordinates go both ways") {
  for (const Vector3& normal : {Vector3(1, 0, 0), Vector3(-0.95, 0.1, 0.2), Vector3(1e-200, 3e-200, 0),
                                Vector3(0, 0, -1e200), Vector3(1, 1, 1)}) {
    const auto disc = NearField::disc({10, -20, 30}, normal, 5);
    const auto rectangle = NearField::rectangle({10, -20, 30}, normal, {0.3, 0.2, 0.9}, 5, 6);
    for (const NearField& field : {disc, rectangle}) {
      Eigen::Matrix3d axes;
      axes << field.first_axis(), field.second_axis(), field.normal();
      CHECK((axes * axes.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < 1e-15);
      CHECK(axes.determinant() == Approx(1));
      const Vector2 plane(1.5, -2.5);
      // coordinates of some 30 mm: a few roundings of 7e-15
      CHECK((field.to_plane(field.to_space(plane)) - plane).norm() < 3e-14);
    }
  }
}

TEST_CASE("a disc gives exactly the samples asked for, all inside, none in the centre") {
  const auto field = NearField::disc({0, 0, 0}, {0, 0, 1}, 50);
  for (std::size_t count : {0u, 1u, 2u, 7u, 1000u}) {
    const auto samples = field.samples(count);
    REQUIRE(samples.size() == count);
    double mean_square = 0;
    for (const FieldSample& sample : samples)
      mean_square += sample.point_mm.squaredNorm() / static_cast<double>(count);
    if (count > 0) CHECK(mean_square == Approx(1250));  // that of an even disc, whatever the count
    for (const FieldSample& sample : samples) {
      const Vector2 plane = field.to_plane(sample.point_mm);
      CHECK(field.contains(plane));
      CHECK(plane.norm() > 0);
      CHECK(sample.normal == field.normal());
    }
  }
}

TEST_CASE("a rectangle gives a grid of nearly square cells") {
  const auto field = NearField::rectangle({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, 300, 100);
  const auto samples = field.samples(75);
  REQUIRE(samples.size() == 75);  // 15 x 5
  CHECK(field.to_plane(samples[0].point_mm).isApprox(Vector2(-140, -40)));
  CHECK(field.to_plane(samples[14].point_mm).isApprox(Vector2(140, -40)));
  CHECK(field.to_plane(samples[74].point_mm).isApprox(Vector2(140, 40)));
  for (std::size_t count = 1; count < 400; ++count) {
    const double got = static_cast<double>(field.samples(count).size());
    CHECK(std::abs(got - static_cast<double>(count)) <=
          0.5 * std::ceil(std::sqrt(3.0 * static_cast<double>(count))));
  }
  CHECK(NearField::rectangle({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, 1e9, 1).samples(5).size() == 5);
}

TEST_CASE("a near field that cannot be is refused") {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  CHECK_THROWS_AS(NearField::disc({0, 0, 0}, {0, 0, 0}, 1), InputError);
  CHECK_THROWS_AS(NearField::disc({0, 0, nan}, {0, 0, 1}, 1), InputError);
  CHECK_THROWS_AS(NearField::disc({0, 0, 0}, {0, 0, inf}, 1), InputError);
  for (double size : {0.0, -1.0, nan, inf}) {
    CHECK_THROWS_AS(NearField::disc({0, 0, 0}, {0, 0, 1}, size), InputError);
    CHECK_THROWS_AS(NearField::rectangle({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, size, 1), InputError);
    CHECK_THROWS_AS(NearField::rectangle({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, 1, size), InputError);
  }
  CHECK_THROWS_AS(NearField::rectangle({0, 0, 0}, {0, 0, 1}, {0, 0, -3}, 1, 1), InputError);
  CHECK_THROWS_AS(NearField::rectangle({0, 0, 0}, {0, 0, 1}, {nan, 0, 0}, 1, 1), InputError);
  CHECK_THROWS_AS(NearField::disc({0, 0, 0}, {0, 0, 1}, 1, Material::matt(0.7, 0.4)), InputError);
  CHECK_THROWS_AS(NearField::disc({0, 0, 0}, {0, 0, 1}, 1, Material::matt(nan)), InputError);
  CHECK_THROWS_AS(NearField::disc({0, 0, 0}, {0, 0, 1}, 1, Material::matt(0, -0.1)), InputError);
  CHECK_NOTHROW(NearField::disc({0, 0, 0}, {0, 0, 1}, 1, Material::matt(0.7, 0.3)));
}
