#include "cad/refine.h"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>

#include "support/cad/random_profile.h"
#include "support/cad/sample_profiles.h"

using namespace catoptric;

namespace {

/// Greatest difference of two curves at 1,000 parameters: position, beyond a rounding of the parameter, over
/// size; first and second derivative
/// over the greatest of its kind plus what a rounding of the finer curve's control points does to it: degree
/// over span, once and twice, times the size.
struct Difference {
  double position = 0, first = 0, second = 0;
};

Difference difference(const Profile& coarse, const Profile& fine) {
  constexpr int count = 1000;
  Difference most;
  double size = 0, speed = 0, bend = 0;
  const double begin = coarse.first_parameter(), end = coarse.last_parameter();
  double narrowest = end - begin;
  for (const RationalSpan& span : fine.spans()) narrowest = std::min(narrowest, span.last - span.first);
  for (int i = 0; i <= count; ++i) {
    const double u = begin + (end - begin) * i / count;
    const MeridianPoint p = coarse.at(u), q = fine.at(u);
    size = std::max(size, std::hypot(p.r_mm, p.z_mm));
    speed = std::max(speed, std::hypot(p.dr, p.dz));
    bend = std::max(bend, std::hypot(p.ddr, p.ddz));
    const double by_parameter = std::numeric_limits<double>::epsilon() * std::abs(u) * std::hypot(p.dr, p.dz);
    most.position = std::max(most.position, std::hypot(p.r_mm - q.r_mm, p.z_mm - q.z_mm) - by_parameter);
    most.first = std::max(most.first, std::hypot(p.dr - q.dr, p.dz - q.dz));
    most.second = std::max(most.second, std::hypot(p.ddr - q.ddr, p.ddz - q.ddz));
  }
  const double rate = fine.degree() / narrowest;
  return {most.position / size, most.first / (speed + rate * size),
          most.second / (bend + rate * rate * size)};
}

void check_same(const Profile& before, const Profile& after) {
  const Difference d = difference(before, after);
  INFO(fmt::format("position {:.2g}, first {:.2g}, second {:.2g}", d.position, d.first, d.second));
  CHECK(d.position <= 1e-14);
  CHECK(d.first <= 1e-14);
  CHECK(d.second <= 1e-14);
  CHECK(after.first_parameter() == before.first_parameter());
  CHECK(after.last_parameter() == before.last_parameter());
}

std::vector<Profile> profiles(int degree) {
  std::vector<Profile> list;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) list.push_back(test::random_profile(degree, seed));
  list.push_back(test::wavy_profile(degree, false));
  Profile extreme = test::random_profile(degree, 4);  // weights 1e-4, 1, 1e4 in turn
  std::vector<ControlPoint> points = extreme.points();
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i].weight = std::pow(10.0, 4 * static_cast<double>(i % 3) - 4);
  list.emplace_back(degree, extreme.knots(), points);
  return list;
}

}  // namespace

TEST_CASE("a higher degree leaves the curve as it is", "[refine]") {
  for (int degree = 1; degree <= 8; ++degree)
    for (const Profile& profile : profiles(degree))
      for (int to = degree + 1; to <= 9; ++to) {
        INFO("degree " << degree << " to " << to << ", " << profile.spans().size() << " spans");
        const Profile higher = cad::elevated(profile, to);
        CHECK(higher.degree() == to);
        CHECK(higher.points().size() ==
              profile.points().size() + profile.spans().size() * static_cast<std::size_t>(to - degree));
        check_same(profile, higher);
      }
}

TEST_CASE("more knots leave the curve as it is", "[refine]") {
  for (int degree = 1; degree <= 9; ++degree)
    for (const Profile& profile : profiles(degree)) {
      INFO("degree " << degree << ", " << profile.spans().size() << " spans");
      for (int parts : {2, 3, 8}) {
        const Profile finer = cad::split_spans(profile, parts);
        CHECK(finer.spans().size() == profile.spans().size() * static_cast<std::size_t>(parts));
        check_same(profile, finer);
      }
      const double middle = 0.6 * profile.first_parameter() + 0.4 * profile.last_parameter();
      const std::vector<double> kink(static_cast<std::size_t>(degree), middle);
      const Profile broken = cad::with_knots(profile, kink);  // a kink may now be made there
      CHECK(broken.points().size() == profile.points().size() + kink.size());
      check_same(profile, broken);
    }
}

TEST_CASE("knots that are there already are repeated, and the other samples hold", "[refine]") {
  const Profile profile = test::multiple_knots_profile();  // 0.1 once, 0.3 twice, 0.7 four times
  const Profile finer = cad::with_knots(profile, std::vector<double>{0.3, 0.1, 0.3, 0.45});
  CHECK(std::count(finer.knots().begin(), finer.knots().end(), 0.3) == 4);
  CHECK(std::count(finer.knots().begin(), finer.knots().end(), 0.1) == 2);
  check_same(profile, finer);
  check_same(profile, cad::elevated(profile, 7));
  for (const Profile& each : {test::hemisphere(1e-3), test::hemisphere(1e5), test::paraboloid()}) {
    check_same(each, cad::elevated(each, 5));
    check_same(each, cad::split_spans(each, 4));
  }
  const Profile unclamped(2, {0, 1, 2, 3, 4, 5, 6}, {{0, 10, 1}, {5, 10, 2}, {10, 5, 1}, {11, 2, 3}});
  check_same(unclamped, cad::elevated(unclamped, 4));
  check_same(unclamped, cad::split_spans(unclamped, 3));
}

TEST_CASE("equal weights keep their value, and nothing to do changes nothing", "[refine]") {
  const Profile profile = Profile::bezier({{0, 100, 3}, {50, 100, 3}, {100, 50, 3}});
  for (const Profile& refined : {cad::elevated(profile, 4), cad::split_spans(profile, 2)})
    for (const ControlPoint& point : refined.points()) CHECK(point.weight == 3);
  CHECK(cad::elevated(profile, 2) == profile);
  CHECK(cad::split_spans(profile, 1) == profile);
  CHECK(cad::with_knots(profile, {}) == profile);
}

TEST_CASE("a smooth vertex on the axis stays one, bit for bit", "[refine]") {
  for (const Profile& profile : {test::paraboloid(), test::hemisphere(30)})
    for (const Profile& refined : {cad::elevated(profile, 3), cad::elevated(profile, 9),
                                   cad::split_spans(profile, 2), cad::split_spans(profile, 7)}) {
      CHECK(refined.points()[0].r_mm == 0);
      CHECK(refined.points()[1].z_mm == refined.points()[0].z_mm);
    }
}

TEST_CASE("what cannot be refined is refused", "[refine]") {
  const Profile profile = test::paraboloid();
  const auto with = [&](std::vector<double> knots) { return cad::with_knots(profile, knots); };
  CHECK_THROWS_AS(cad::elevated(profile, 1), InputError);
  CHECK_THROWS_AS(cad::elevated(profile, 10), InputError);
  CHECK_THROWS_AS(with({0.0}), InputError);
  CHECK_THROWS_AS(with({1.0}), InputError);
  CHECK_THROWS_AS(with({-1.0}), InputError);
  CHECK_THROWS_AS(with({std::nan("")}), InputError);
  CHECK_THROWS_AS(with({0.5, 0.5, 0.5}), InputError);
  check_same(profile, with({0.5, std::nextafter(0.5, 1.0)}));  // a rounding apart is apart
  CHECK_THROWS_AS(cad::split_spans(profile, 0), InputError);
  const Profile narrow(2, {0, 0, 0, 0.5, std::nextafter(0.5, 1.0), 1, 1, 1},
                       {{0, 10, 1}, {3, 10, 1}, {5, 9, 1}, {8, 8, 1}, {10, 5, 1}});
  CHECK_THROWS_AS(cad::split_spans(narrow, 2), Error);
}
