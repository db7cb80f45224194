#include "design/free_profile.h"

#include <Eigen/QR>
#include <catch2/catch.hpp>
#include <cmath>

using namespace catoptric;
using namespace catoptric::design;

namespace {

std::vector<std::string> names(const FreeProfile& family) {
  std::vector<std::string> list;
  for (const auto& variable : family.variables()) list.push_back(variable.name);
  return list;
}

std::vector<double> starts(const FreeProfile& family) {
  std::vector<double> list;
  for (const auto& variable : family.variables()) list.push_back(variable.start);
  return list;
}

const Profile paraboloid = Profile::bezier({{0, 100, 1}, {50, 100, 1}, {100, 50, 1}});
const std::vector<ControlPoint> seven{{0, 100, 1}, {20, 100, 2}, {45, 98, 0.7}, {60, 90, 1.3},
                                      {80, 75, 3}, {95, 60, 1},  {110, 35, 1.7}};

/// How the curve's shape changes with each component of eq. 6: normal displacements at many stations, and how
/// far the two ends move along the curve.
Eigen::MatrixXd shape_derivatives(const Profile& profile) {
  constexpr int stations = 60;
  const std::size_t count = profile.points().size();
  Eigen::MatrixXd result(stations + 3, static_cast<Eigen::Index>(3 * count));
  const double a = profile.first_parameter(), b = profile.last_parameter();
  for (std::size_t c = 0; c < 3 * count; ++c) {
    std::vector<ControlPoint> up = profile.points(), down = up;
    const double h = 1e-6;
    for (auto [points, sign] : {std::pair{&up, 1.0}, std::pair{&down, -1.0}}) {
      ControlPoint& point = (*points)[c / 3];
      if (c % 3 == 0) point.r_mm += sign * h + (c == 0 ? 1e-3 : 0);  // not across the axis
      if (c % 3 == 1) point.z_mm += sign * h;
      if (c % 3 == 2) point.weight *= 1 + sign * h;
    }
    const Profile high(profile.degree(), profile.knots(), up), low(profile.degree(), profile.knots(), down);
    for (int i = 0; i <= stations; ++i) {
      const double u = a + (b - a) * i / stations;
      const MeridianPoint at = profile.at(u), p = high.at(u), q = low.at(u);
      const double dr = (p.r_mm - q.r_mm) / (2 * h), dz = (p.z_mm - q.z_mm) / (2 * h);
      const double speed = std::hypot(at.dr, at.dz);
      const auto column = static_cast<Eigen::Index>(c);
      result(i, column) = (dz * at.dr - dr * at.dz) / speed;
      if (i == 0) result(stations + 1, column) = (dr * at.dr + dz * at.dz) / speed;
      if (i == stations) result(stations + 2, column) = (dr * at.dr + dz * at.dz) / speed;
    }
  }
  return result;
}

/// Of columns brought to length 1; those that do nothing but the differences' roundings become 0.
long rank(Eigen::MatrixXd matrix) {
  const double most = matrix.colwise().norm().maxCoeff();
  for (Eigen::Index c = 0; c < matrix.cols(); ++c) {
    const double norm = matrix.col(c).norm();
    matrix.col(c) *= norm > 1e-6 * most ? 1 / norm : 0.0;
  }
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factors(matrix);
  factors.setThreshold(1e-6);  // the differences above are good to 1e-9
  return factors.rank();
}

}  // namespace

TEST_CASE("the paper's nine dimensions are five", "[free_profile]") {
  const FreeProfile family(paraboloid, {});
  CHECK(names(family) == std::vector<std::string>{"z0", "r1", "logw1", "r2", "z2"});
  FreeProfileOptions held;
  held.hold_vertex = true;
  CHECK(names(FreeProfile(paraboloid, held)) == std::vector<std::string>{"r1", "logw1", "r2", "z2"});
}

TEST_CASE("a vertex that is a point, or a hole in the middle, keeps its freedom", "[free_profile]") {
  CHECK(names(FreeProfile(Profile::bezier({{0, 100, 1}, {50, 90, 1}, {100, 50, 1}}), {})) ==
        std::vector<std::string>{"z0", "r1", "z1", "logw1", "r2", "z2"});
  CHECK(names(FreeProfile(Profile::bezier({{10, 100, 1}, {50, 100, 1}, {100, 50, 1}}), {})) ==
        std::vector<std::string>{"z0", "r1", "z1", "logw1", "r2", "z2"});
}

TEST_CASE("what a free profile leaves out of the weights, and only that, is flat", "[free_profile]") {
  std::vector<Profile> profiles{
      paraboloid, Profile::bezier(seven), Profile(2, Profile::uniform_knots(2, 7), seven),
      Profile(3, Profile::uniform_knots(3, 7), seven), Profile(1, Profile::uniform_knots(1, 7), seven)};
  // Kinks: single spans on both sides; a single span before a stretch of two; after one.
  profiles.emplace_back(3, std::vector<double>{0, 0, 0, 0, .4, .4, .4, 1, 1, 1, 1}, seven);
  profiles.emplace_back(2, std::vector<double>{0, 0, 0, .3, .3, .5, .6, 1, 1, 1}, seven);
  profiles.emplace_back(2, std::vector<double>{0, 0, 0, .2, .3, .3, .7, 1, 1, 1}, seven);
  for (const Profile& profile : profiles) {
    INFO("degree " << profile.degree() << ", " << profile.spans().size() << " spans");
    const Eigen::MatrixXd shape = shape_derivatives(profile);
    std::vector<Eigen::Index> kept;
    const FreeProfile family(profile, {});
    const auto listed = names(family);
    for (std::size_t point = 0; point < profile.points().size(); ++point) {
      kept.push_back(static_cast<Eigen::Index>(3 * point));
      kept.push_back(static_cast<Eigen::Index>(3 * point + 1));
      if (std::find(listed.begin(), listed.end(), "logw" + std::to_string(point)) != listed.end())
        kept.push_back(static_cast<Eigen::Index>(3 * point + 2));
    }
    CHECK(kept.size() < static_cast<std::size_t>(shape.cols()));
    CHECK(rank(shape(Eigen::all, kept)) == rank(shape));  // nothing that shapes was lost
    if (profile.degree() > 1)  // points along a straight line between two others move nothing
      CHECK(rank(shape(Eigen::all, kept)) == static_cast<long>(kept.size()));  // nothing flat was kept
  }
}

TEST_CASE("the start is the base, and the smooth vertex stays smooth", "[free_profile]") {
  FreeProfileOptions options;
  options.unit = LengthUnit::centimetre;
  const Profile base(3, Profile::uniform_knots(3, 7), seven);
  const FreeProfile family(base, options);
  std::vector<double> x = starts(family);
  CHECK(x[0] == 10);
  const auto same = family.at(x);
  REQUIRE(same);
  for (std::size_t i = 0; i < seven.size(); ++i) {
    CHECK(same->points()[i].r_mm == Approx(seven[i].r_mm).epsilon(1e-15).margin(0));
    CHECK(same->points()[i].z_mm == Approx(seven[i].z_mm).epsilon(1e-15).margin(0));
    CHECK(same->points()[i].weight == Approx(seven[i].weight).epsilon(1e-15).margin(0));
  }
  x[0] = 11;
  const auto moved = family.at(x);
  REQUIRE(moved);
  CHECK(moved->points()[0] == ControlPoint{0, 110, 1});
  CHECK(moved->points()[1].z_mm == 110);
  CHECK(moved->at(0).dz == 0);
}

TEST_CASE("the chain is the derivative of the components by the variables", "[free_profile]") {
  FreeProfileOptions options;
  options.unit = LengthUnit::inch;
  const FreeProfile family(Profile(3, Profile::uniform_knots(3, 7), seven), options);
  std::vector<double> x = starts(family);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += 0.01 * static_cast<double>(i % 3);
  const auto profile = family.at(x);
  REQUIRE(profile);
  const Eigen::MatrixXd chain = family.chain(*profile);
  REQUIRE(chain.cols() == static_cast<Eigen::Index>(x.size()));
  const double h = 1e-6;
  for (std::size_t v = 0; v < x.size(); ++v) {
    std::vector<double> up = x, down = x;
    up[v] += h;
    down[v] -= h;
    const auto high = family.at(up), low = family.at(down);
    REQUIRE(high);
    REQUIRE(low);
    for (std::size_t i = 0; i < seven.size(); ++i) {
      const ControlPoint &p = high->points()[i], &q = low->points()[i];
      const double by[]{(p.r_mm - q.r_mm) / (2 * h), (p.z_mm - q.z_mm) / (2 * h),
                        (p.weight - q.weight) / (2 * h)};
      for (std::size_t c = 0; c < 3; ++c)
        CHECK(chain(static_cast<Eigen::Index>(3 * i + c), static_cast<Eigen::Index>(v)) ==
              Approx(by[c]).margin(1e-6));  // roundings of 100 mm over 2 h
    }
  }
}

TEST_CASE("all points stay in the package, and a base that does not is refused", "[free_profile]") {
  FreeProfileOptions options;
  options.r_greatest_mm = 120;
  options.z_least_mm = 0;
  options.z_greatest_mm = 130;
  for (const auto& variable : FreeProfile(paraboloid, options).variables()) {
    INFO(variable.name);
    if (variable.name[0] == 'r') CHECK((variable.lower == 0 && variable.upper == 120));
    if (variable.name[0] == 'z') CHECK((variable.lower == 0 && variable.upper == 130));
    if (variable.name[0] == 'l')
      CHECK((variable.lower == std::log(0.05) && variable.upper == std::log(20.0)));
  }
  options.r_greatest_mm = 99;
  CHECK_THROWS_WITH(FreeProfile(paraboloid, options), Catch::Contains("r2 = 100"));
}

TEST_CASE("unclamped knots are refused, and a base that crosses the axis on the way is nothing",
          "[free_profile]") {
  CHECK_THROWS_AS(FreeProfile(Profile(2, {0, 1, 2, 3, 4, 5}, {{0, 10, 1}, {5, 10, 1}, {10, 5, 1}}), {}),
                  InputError);
  const FreeProfile family(paraboloid, {});
  std::vector<double> x = starts(family);
  x[3] = -20;
  CHECK_FALSE(family.at(x));
}
