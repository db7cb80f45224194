#include "sim/tubes_jacobian.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "base/units.h"

/// Derivatives of the field of ray tubes against central differences of it, extrapolated (Richardson).

using namespace catoptric;
using namespace catoptric::sim;

namespace {

const PointSource source({0, 0, 50}, pi / 100);
const FieldPlane ground{0, true};
constexpr double kernel_mm = 5;

TubesOptions fine() {
  TubesOptions options;
  options.kernel_radius_mm = kernel_mm;
  options.tolerance_w_per_mm2 = from_w_per_m2(1e-9);
  return options;
}

std::vector<double> radii() {
  std::vector<double> values;
  for (int i = 0; i <= 24; ++i) values.push_back(110.0 * i / 24);
  return values;
}

double& coordinate(ControlPoint& point, std::size_t which) {
  return which == 0 ? point.r_mm : which == 1 ? point.z_mm : point.weight;
}

Eigen::VectorXd field_of(const Profile& profile, std::size_t variable, double change,
                         const Material& mirror) {
  std::vector<ControlPoint> points = profile.points();
  coordinate(points[variable / 3], variable % 3) += change;
  const auto field = tubes_field(source, Profile(profile.degree(), profile.knots(), points), mirror, ground,
                                 radii(), fine());
  return Eigen::Map<const Eigen::VectorXd>(field.irradiance.data(),
                                           static_cast<Eigen::Index>(field.irradiance.size()));
}

/// Largest difference between the derivatives and central differences by one variable, over the largest
/// derivative by it.
double worst(const Profile& profile, double step_mm = 0.04, const Material& mirror = {0.9, 0}) {
  const TubesJacobian got = tubes_jacobian(source, profile, mirror, ground, radii(), fine());
  CHECK(got.unmoved_w_per_mm2 == 0);
  double off = 0;
  for (std::size_t v = 0; v < 3 * profile.points().size(); ++v) {
    // A vertex moves off the axis in one direction only; its r is held to the axis.
    if (v == 0 && profile.points()[0].r_mm == 0) continue;
    const double step = v % 3 == 2 ? step_mm / 20 : step_mm;
    const auto slope = [&](double d) -> Eigen::VectorXd {
      return (field_of(profile, v, d, mirror) - field_of(profile, v, -d, mirror)) / (2 * d);
    };
    const Eigen::VectorXd d1 = slope(step), d2 = slope(step / 2), d3 = slope(step / 4);
    const Eigen::VectorXd a = (4 * d2 - d1) / 3, b = (4 * d3 - d2) / 3, best = (16 * b - a) / 15;
    const double miss = (got.by_variable.col(static_cast<Eigen::Index>(v)) - best).cwiseAbs().maxCoeff();
    off = std::max(off, miss / best.cwiseAbs().maxCoeff());
  }
  return off;
}

}  // namespace

TEST_CASE("derivatives on the paraboloid and the paper's starts", "[tubes][jacobian]") {
  for (const auto& [w1, x2] : {std::pair{1.0, 100.0}, {1.6, 90.0}, {1.8, 70.0}, {std::sqrt(0.5), 50.0}}) {
    INFO("w1 " << w1 << ", x2 " << x2);
    CHECK(worst(Profile::bezier({{0, 100, 1}, {50, 100, w1}, {x2, 50, 1}})) < 5e-7);
  }
}

TEST_CASE("derivatives by more control points than are done at once, with knots", "[tubes][jacobian]") {
  CHECK(worst(Profile(3, Profile::uniform_knots(3, 6),
                      {{0, 100, 1}, {20, 100, 1}, {45, 92, 1.2}, {70, 85, 0.9}, {88, 66, 1}, {100, 48, 1}})) <
        5e-7);
}

TEST_CASE("derivatives through many bounces, with rims that shade", "[tubes][jacobian]") {
  // Ten bounces multiply every motion by thousands: the differences, not the derivatives, are worth 1e-6
  // here.
  CHECK(worst(Profile::bezier({{30, 90, 1}, {70, 80, 1}, {60, 10, 1}}), 0.004) < 1e-5);
  CHECK(worst(Profile::bezier({{20, 90, 1}, {70, 95, 1}, {75, 30, 1}}), 0.01) < 5e-7);
}

TEST_CASE("derivatives are refused where they are not given", "[tubes][jacobian]") {
  const Profile profile = Profile::bezier({{0, 100, 1}, {50, 100, 1}, {100, 50, 1}});
  CHECK_THROWS_AS(tubes_jacobian(source, profile, {}, ground, radii(), {}), InputError);
  CHECK_THROWS_AS(tubes_jacobian(source, profile, {0.5, 0.4}, ground, radii(), fine()), InputError);
  CHECK_THROWS_AS(tubes_jacobian(source, profile, Material::metal(1.1, 6.6), ground, radii(), fine()),
                  InputError);
  CHECK(tubes_jacobian(source, profile, {}, ground, {}, fine()).by_variable.rows() == 0);
}
