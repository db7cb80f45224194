#include "base/planar_hits.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "base/tolerance.h"
#include "base/units.h"
#include "cad/engines.h"

/// The section in two dimensions against the engine in space: the same hits, none lost, none invented.

using namespace catoptric;

namespace {

PlanarRay towards(double x, double z, double to_x, double to_z) {
  const double length = std::hypot(to_x - x, to_z - z);
  return {x, z, (to_x - x) / length, (to_z - z) / length};
}

/// The same ray in the plane y = 0, where the signed radius is the coordinate itself and nothing rounds.
Ray lifted(const PlanarRay& ray) { return {{ray.x_mm, 0, ray.z_mm}, {ray.dx, 0, ray.dz}}; }

Profile wavy(int degree, int points, double weight_spread, std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<ControlPoint> poles;
  for (int i = 0; i < points; ++i) {
    const double t = static_cast<double>(i) / (points - 1);
    poles.push_back({100 * std::max(0.0, t + (i > 0 ? 0.25 * (unit(random) - 0.5) : 0)),
                     80 * (1 - t * t) + 40 * (unit(random) - 0.5),
                     std::exp(weight_spread * (unit(random) - 0.5))});
  }
  const std::vector<double> knots = Profile::uniform_knots(degree, poles.size());
  return Profile(degree, knots, std::move(poles));
}

/// Rays by the thousand against rays one by one.
void same_first_hits(const PlanarMirror& section, const std::vector<PlanarRay>& rays, double beyond) {
  const std::size_t count = rays.size();
  std::vector<std::vector<double>> in(4), out(5, std::vector<double>(count));
  for (const PlanarRay& ray : rays) {
    in[0].push_back(ray.x_mm);
    in[1].push_back(ray.z_mm);
    in[2].push_back(ray.dx);
    in[3].push_back(ray.dz);
  }
  section.first_hits({in[0], in[1], in[2], in[3]}, beyond, {out[0], out[1], out[2], out[3], out[4]});
  for (std::size_t i = 0; i < count; ++i) {
    const auto hit = section.first_hit(rays[i], beyond);
    INFO("ray " << i << " from (" << rays[i].x_mm << ", " << rays[i].z_mm << ")");
    REQUIRE(out[0][i] == (hit ? hit->distance_mm : HUGE_VAL));
    if (!hit) continue;
    REQUIRE(out[1][i] == hit->x_mm);
    REQUIRE(out[2][i] == hit->z_mm);
    REQUIRE(std::abs(out[3][i] - hit->tx) <= 4e-16);  // a root and two divisions, in another order
    REQUIRE(std::abs(out[4][i] - hit->tz) <= 4e-16);
  }
}

void same_hits(const Profile& profile, int rays, std::mt19937_64& random) {
  const PlanarMirror section(profile);
  const auto engine = cad::make_meridian_reflector(profile);
  const auto probe = engine->probe();
  const double size = profile.diagonal_mm(), bound = Tolerance::for_scale(size).length_mm;
  std::uniform_real_distribution<double> across(-120, 120), up(-60, 160);
  std::vector<PlanarHit> hits;
  std::size_t met = 0;
  std::vector<PlanarRay> together;
  for (int i = 0; i < rays; ++i) {
    const PlanarRay ray = towards(i % 3 == 0 ? 0.0 : across(random), up(random), across(random), up(random));
    together.push_back(ray);
    section.all_hits(ray, 0, hits);
    const auto expected = probe->all_hits(lifted(ray), 0);
    INFO("ray " << i << " from (" << ray.x_mm << ", " << ray.z_mm << ") along (" << ray.dx << ", " << ray.dz
                << ")");
    REQUIRE(hits.size() == expected.size());
    const auto first = section.first_hit(ray, 0);
    REQUIRE(first.has_value() == !expected.empty());
    if (first) REQUIRE(first->distance_mm == hits.front().distance_mm);
    for (std::size_t k = 0; k < hits.size(); ++k) {
      const Vector3 point(hits[k].x_mm, 0, hits[k].z_mm);
      // Along a grazing ray the hit runs away like the rounding over the sine of the angle.
      const double sine = std::abs(hits[k].tx * ray.dz - hits[k].tz * ray.dx);
      REQUIRE((point - expected[k].point_mm).norm() <= bound / std::min(1.0, 100 * sine));
      REQUIRE(std::abs(hits[k].tx * expected[k].normal.x() + hits[k].tz * expected[k].normal.z()) <=
              1e-9 / sine);  // a part's rounding times the curvature of the tightest bends
    }
    met += hits.size();
  }
  REQUIRE(met > static_cast<std::size_t>(rays) / 4);
  same_first_hits(section, together, 0);
  same_first_hits(section, together, Tolerance::for_scale(size).lift_mm);
  // From the axis and to the right, where the image behind is left out; some to the vertex and the rim.
  together.clear();
  const MeridianPoint first = profile.at(profile.first_parameter()),
                      last = profile.at(profile.last_parameter());
  for (int i = 0; i < rays; ++i) {
    PlanarRay ray = towards(0, up(random), std::abs(across(random)), up(random));
    if (i % 7 == 0) ray = towards(0, 50, 1e-15 * i * first.r_mm + 1e-17 * i, first.z_mm);
    if (i % 7 == 1) ray = towards(0, 50, last.r_mm, last.z_mm * (1 + 1e-16 * (i % 5 - 2)));
    together.push_back(ray);
  }
  same_first_hits(section, together, 0);
}

}  // namespace

TEST_CASE("the section in the plane meets what the mirror in space meets", "[planar][long]") {
  std::mt19937_64 random(20);
  SECTION("paraboloid") {
    same_hits(Profile::bezier({{0, 100, 1}, {50, 100, 1}, {100, 50, 1}}), 20000, random);
  }
  SECTION("start A") {
    same_hits(Profile::bezier({{0, 100, 1}, {50, 100, 1.6}, {90, 50, 1}}), 20000, random);
  }
  SECTION("cone") { same_hits(Profile::bezier({{0, 100, 1}, {100, 50, 1}}), 20000, random); }
  SECTION("cylinder") { same_hits(Profile::bezier({{60, 100, 1}, {60, 10, 1}}), 20000, random); }
  for (int degree = 1; degree <= 9; ++degree) SECTION("degree " + std::to_string(degree)) {
      for (int part = 0; part < 8; ++part)
        same_hits(wavy(degree, degree + 1 + 2 * part, part % 2 == 0 ? 0.0 : 4.0, random), 1500, random);
    }
}

TEST_CASE("the vertex, the rim and the axis in the plane", "[planar]") {
  const PlanarMirror bowl(Profile::bezier({{0, 100, 1}, {50, 100, 1}, {100, 50, 1}}));
  std::vector<PlanarHit> hits;
  bowl.all_hits({0, 0, 0, 1}, 0, hits);  // along the axis
  REQUIRE(hits.size() == 1);
  CHECK(hits[0].distance_mm == 100);
  CHECK(std::abs(hits[0].tz) < 1e-15);  // horizontal, to rounding
  CHECK(std::abs(hits[0].curvature * hits[0].tx) == Approx(1.0 / 100).epsilon(1e-13));  // z = 100 - r^2 / 200
  for (const double tilt : {1e-3, -1e-3, 1e-9, -1e-9}) {  // through the vertex from either side
    const double length = std::hypot(100 * tilt, 100.0);
    bowl.all_hits({-100 * tilt, 0, 100 * tilt / length, 100 / length}, 0, hits);
    REQUIRE(hits.size() == 1);
    CHECK(std::abs(hits[0].x_mm) < 1e-12 * 300);
  }
  bowl.all_hits({0, 50, 1, 0}, 0, hits);  // to the rim, which belongs to the mirror
  REQUIRE(hits.size() == 1);
  CHECK(hits[0].x_mm == 100);
  bowl.all_hits({0, std::nextafter(50.0, 0.0), 1, 0}, 0, hits);
  CHECK(hits.empty());
  bowl.all_hits({-200, 75, 1, 0}, 0, hits);  // across: both sides
  REQUIRE(hits.size() == 2);
  CHECK(hits[0].side == -1);
  CHECK(hits[0].x_mm == Approx(-std::sqrt(5000.0)).epsilon(1e-14));
  CHECK(hits[1].side == 1);
  // A hit leaves the mirror: its own start does not count beyond the lift.
  CHECK_FALSE(bowl.first_hit({hits[1].x_mm, hits[1].z_mm, 0, -1}, Tolerance::for_scale(300).lift_mm));
}

TEST_CASE("curvature and tangent are those of a circle, whatever the side and the distance", "[planar]") {
  const double w = std::sqrt(0.5);
  for (const double scale : {1e-3, 1.0, 1e6}) {
    const PlanarMirror dome(Profile::bezier({{0, scale, 1}, {scale, scale, w}, {scale, 0, 1}}));
    for (const double angle : {0.1, 0.7, 1.5, -0.4, -1.2})
      for (const double far : {0.0, 0.5, -1e5}) {  // origins along the same line, even far behind
        const double dx = std::sin(angle), dz = std::cos(angle);
        const auto hit = dome.first_hit({far * scale * dx, far * scale * dz, dx, dz}, 0);
        REQUIRE(hit);
        const double off = std::abs(far) > 1 ? 1e-11 : 1e-14;  // the origin's own rounding, from afar
        CHECK(std::abs(hit->x_mm - scale * dx) <= off * scale);
        CHECK(std::abs(hit->z_mm - scale * dz) <= off * scale);
        CHECK(std::abs(hit->curvature) * scale == Approx(1).epsilon(1e-11));
        // The centre lies at curvature^-1 times the tangent turned counter-clockwise.
        CHECK(std::abs(hit->x_mm - hit->tz / hit->curvature) <= 2e-11 * scale);
        CHECK(std::abs(hit->z_mm + hit->tx / hit->curvature) <= 2e-11 * scale);
      }
  }
}

TEST_CASE("a touch counts once, a line in the surface not at all", "[planar]") {
  std::vector<PlanarHit> hits;
  const PlanarMirror bump(Profile::bezier({{20, 0, 1}, {60, 80, 1}, {100, 0, 1}}));  // top at (60, 40)
  bump.all_hits({0, 40, 1, 0}, 0, hits);
  CHECK(hits.size() == 1);
  const PlanarMirror quartic(
      Profile::bezier({{20, 0, 1}, {40, 40, 1}, {60, 40, 1}, {80, 40, 1}, {100, 0, 1}}));
  bump.all_hits({0, 39.9, 1, 0}, 0, hits);
  CHECK(hits.size() == 2);
  quartic.all_hits({0, 35, 1, 0}, 0, hits);  // its top: 40 (1 - 1/8)
  CHECK(hits.size() == 1);
  const PlanarMirror tube(Profile::bezier({{60, 100, 1}, {60, 10, 1}}));
  tube.all_hits({60, 0, 0, 1}, 0, hits);
  CHECK(hits.empty());
}
