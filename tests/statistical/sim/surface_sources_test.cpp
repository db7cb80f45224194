#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "base/random_stream.h"
#include "base/units.h"
#include "sim/cylinder_source.h"
#include "sim/frame.h"
#include "sim/projection_map.h"
#include "sim/rectangle_source.h"
#include "sim/sphere_source.h"
#include "support/statistics.h"

/// What surfaces emit: evenly from their area, and from every place by Lambert's law about the place's own
/// normal, though directions are drawn first.

using namespace catoptric;
using namespace catoptric::sim;

namespace {

constexpr int bins = 10;
const Vector3 center(4, 5, 30), axis = Vector3(0.3, -0.2, 1).normalized();

/// Where on the surface a ray begins, as two numbers that are even by area, and the normal there.
struct Chart {
  double first, second;
  Vector3 normal;
};
using ChartOf = std::function<Chart(const Vector3&)>;

std::size_t bin(double share) {
  return std::min<std::size_t>(bins - 1, static_cast<std::size_t>(std::max(0.0, share) * bins));
}

/// p-value of place and direction together, which for Lambert's law are even in the square of the cosine.
double even_p(
    const MappedSource& source, const ChartOf& chart_of,
    const std::function<double(double)>& share = [](double cosine) { return cosine * cosine; }) {
  const ProjectionMap all = source.all_directions();
  std::vector<double> counts(bins * bins * bins, 0);
  for (std::uint64_t i = 0; i < 200'000; ++i) {
    RandomStream stream(9, Purpose::test, i);
    std::array<double, 4> numbers;
    for (double& number : numbers) number = stream.uniform();
    const Ray ray = source.emit(all, numbers);
    const Chart chart = chart_of(ray.origin_mm);
    const double cosine = ray.direction.dot(chart.normal);
    REQUIRE(cosine > -1e-12);
    counts[(bin(chart.first) * bins + bin(chart.second)) * bins + bin(share(cosine))] += 1;
  }
  return test::chi_square_even_p(counts);
}

void check(const MappedSource& source, const ChartOf& chart_of) {
  CAPTURE(source.words());
  CHECK(source.power_into_w(source.all_directions()) == Approx(source.power_w()).epsilon(1e-14));
  CHECK(test::plausible(even_p(source, chart_of)));
  CHECK(test::rejected(even_p(source, chart_of, [](double cosine) { return cosine; })));
  const ChartOf twin = [&](const Vector3& at) {
    Chart chart = chart_of(at);
    chart.first = std::pow(chart.first, 1.05);
    return chart;
  };
  CHECK(test::rejected(even_p(source, twin)));
}

double turns(double y, double x) { return std::atan2(y, x) / (2 * pi) + 0.5; }

}  // namespace

TEST_CASE("a rectangle, a sphere and a cylinder emit evenly from their area and by Lambert's law") {
  const Eigen::Matrix3d frame = frame_about(axis);
  check(LambertianRectangle(center, axis, frame.col(0), 4, 2, 3), [&](const Vector3& at) {
    const Vector3 local = frame.transpose() * (at - center);
    return Chart{local.x() / 4 + 0.5, local.y() / 2 + 0.5, axis};
  });
  check(LambertianSphere(center, 2, 3), [&](const Vector3& at) {
    const Vector3 out = (at - center) / 2;
    return Chart{0.5 * (1 + out.z()), turns(out.y(), out.x()), out};
  });
  check(LambertianCylinder(center, axis, 1, 6, 3), [&](const Vector3& at) {
    const Vector3 local = frame.transpose() * (at - center);
    return Chart{local.z() / 6 + 0.5, turns(local.y(), local.x()),
                 local.x() * frame.col(0) + local.y() * frame.col(1)};
  });
}
