#include <catch2/catch.hpp>
#include <cmath>

#include "base/units.h"
#include "sim/projection_map.h"
#include "sim/simulation.h"
#include "support/analytic_reflectors.h"
#include "support/crossings.h"
#include "support/emission_points.h"
#include "support/flat_mirror.h"
#include "support/smoothed_field.h"
#include "support/statistics.h"

using namespace catoptric;
using namespace catoptric::sim;

namespace {

constexpr double power = pi / 100;  // makes the paper's paraboloid give 1 + 1 W/m^2 at the centre

PhotonOptions photons(std::uint64_t count, std::uint64_t stream = 0) {
  PhotonOptions options;
  options.photons = count;
  options.stream = stream;
  return options;
}

/// Points of plane z = 0 on rings, far enough apart that kernels of this radius share no photon.
std::vector<FieldSample> rings(std::initializer_list<double> radii, double kernel_radius) {
  std::vector<FieldSample> samples;
  for (double r : radii) {
    const int count = r == 0 ? 1 : static_cast<int>(pi / std::asin(kernel_radius / r));
    for (int i = 0; i < count; ++i) {
      const double angle = 2 * pi * i / count;
      samples.push_back({{r * std::cos(angle), r * std::sin(angle), 0}, {0, 0, 1}});
    }
  }
  return samples;
}

/// Judges estimates of independent places against a closed form E(plane point), in W/mm^2, and shows that
/// the same test rejects a light 3 % stronger.
template <typename Field>
void check_field(const Reflector& mirror, const PointSource& source, double kernel_radius,
                 const std::vector<FieldSample>& samples, std::uint64_t count, const Field& field) {
  const auto near_field = NearField::disc({0, 0, 0}, {0, 0, 1}, 100);
  const EstimateOptions options{Kernel::silverman, {}, kernel_radius};
  const auto got = simulate({source, mirror, {}, near_field}, samples, photons(count), options);
  std::vector<double> expected, stronger;
  for (const FieldSample& sample : samples) {
    expected.push_back(
        test::smoothed(Kernel::silverman, kernel_radius, near_field.to_plane(sample.point_mm), field));
    stronger.push_back(1.03 * expected.back());
  }
  CHECK(test::plausible(test::z_test_p(got.reflected, expected, got.noise)));
  CHECK(test::rejected(test::z_test_p(got.reflected, stronger, got.noise)));
  CHECK(got.counts.interactions == got.counts.met_mirror);  // the closed forms are those of one bounce
}

/// Eq. 12, W/mm^2.
double paraboloid_field(const Vector2& at, double a = 50) {
  const double t = 1 + at.squaredNorm() / (4 * a * a);
  return power / (4 * pi * a * a * t * t);
}

/// Irradiance of an isotropic point at `height` above the plane, W/mm^2; eq. 13.
double point_field(const Vector2& at, double height) {
  const double distance = std::hypot(at.x(), at.y(), height);
  return power * height / (4 * pi * distance * distance * distance);
}

/// A straight mirror line in the meridian, revolved: the light of a source on the axis comes from a ring of
/// image sources. A ray tube of polar angle dtheta carries power/2 sin(theta) dtheta and lands on a ring of
/// width L dtheta / cos(psi), L its whole way from the image and psi its angle with the vertical.
struct ConeField {
  double r_low, z_low, r_high, z_high, source_z;

  double operator()(const Vector2& at) const {
    const double nr = z_high - z_low, nz = r_low - r_high;  // normal of the mirror line
    const double length = std::hypot(nr, nz);
    const double gap = ((0 - r_low) * nr + (source_z - z_low) * nz) / length;
    const double image_r = -2 * gap * nr / length, image_z = source_z - 2 * gap * nz / length;
    double sum = 0;
    for (const double landing : {at.norm(), -at.norm()}) {
      const double dr = landing - image_r, dz = -image_z;
      const double share = ((r_low - image_r) * nr + (z_low - image_z) * nz) / (dr * nr + dz * nz);
      const double mirror_r = image_r + share * dr, mirror_z = image_z + share * dz;
      if (!(share > 0 && share < 1 && mirror_z >= z_low && mirror_z <= z_high)) continue;
      const double sine = mirror_r / std::hypot(mirror_r, mirror_z - source_z);
      const double way = std::hypot(dr, dz);
      sum += power * sine * (std::abs(dz) / way) / (4 * pi * at.norm() * way);
    }
    return sum;
  }
};

}  // namespace

TEST_CASE("paraboloid: 1 + 1 W/m2 at the centre, eq. 12 and 13 across the field", "[long]") {
  const auto mirror = test::paraboloid();
  const PointSource source({0, 0, 50}, power);
  check_field(mirror, source, 8, rings({0, 16, 32, 48, 64, 80}, 8), 1'000'000,
              [](const Vector2& at) { return paraboloid_field(at); });

  const auto field = NearField::disc({0, 0, 0}, {0, 0, 1}, 50);
  const std::vector<FieldSample> center{{{0, 0, 0}, {0, 0, 1}}};
  auto options = photons(1'000'000);
  options.sampler = Sampler::sobol;
  const auto got = simulate({source, mirror, {}, field}, center, options, {Kernel::silverman, {}, 5.0});
  CHECK(to_w_per_m2(got.direct[0]) == Approx(1).epsilon(1e-14));
  // bias of the kernel: E'' r^2 / 8 summed over two axes = 1 - 1/1.00125^2 averaged, 1.25e-3; the noise of
  // random photons would be 1.9 %, of Sobol points less than a tenth of it
  CHECK(to_w_per_m2(got.reflected[0]) == Approx(1).margin(1.3e-3 + 2e-3));

  const auto samples = field.samples(500);
  const auto direct = direct_field({source, mirror, {}, field}, samples);
  for (std::size_t i = 0; i < samples.size(); ++i)
    CHECK(direct[i] == Approx(point_field(field.to_plane(samples[i].point_mm), 50)).epsilon(1e-14));
}

TEST_CASE("paraboloid: half the power is caught and lands inside r = 2 a") {
  const auto mirror = test::paraboloid();
  const PointSource source({0, 0, 50}, power);
  // the photon on the rim lands on the field's edge: the disc is wider by what rounding may do
  const auto field = NearField::disc({0, 0, 0}, {0, 0, 1}, 100 * (1 + 1e-12));
  const auto traced = test::fly({source, mirror, {}, field}, photons(100'000), 0);
  CHECK(traced.energy.emitted_w == Approx(power / 2).epsilon(1e-12));
  CHECK(traced.energy.received_w == Approx(power / 2).epsilon(1e-12));
  CHECK(traced.counts.stored == 100'000);
}

TEST_CASE("paraboloid: every ray arrives at the radius of its flux tube") {
  const auto mirror = test::paraboloid();
  const PointSource source({0, 0, 50}, power);
  const auto field = NearField::disc({0, 0, 0}, {0, 0, 1}, 200);
  const auto traced = test::fly({source, mirror, {}, field}, photons(1000), 0);
  const auto map = ProjectionMap::towards(mirror.profile(), {0, 0, 50});
  const auto numbers = test::emission_points(Sampler::random, photon_key(1, 0), 0, 1000);
  for (const Crossing& crossing : traced.crossings) {
    const auto& number = numbers[crossing.photon()];
    const double cosine = map.direction(number[0], number[1]).z();
    // r = 2 a tan(theta / 2); a cosine is good to 1e-16, which near the axis is 1e-8 of an angle
    CHECK(crossing.plane_mm().norm() ==
          Approx(100 * std::sqrt((1 - cosine) / (1 + cosine))).epsilon(1e-10).margin(2e-6));
  }
}

TEST_CASE("hemisphere of start C: every ray returns through the source, reflected field = direct field",
          "[long]") {
  const auto mirror = test::half_ellipsoid(50, 50, 50);
  const PointSource source({0, 0, 50}, power);
  check_field(mirror, source, 8, rings({0, 16, 32, 48}, 8), 2'000'000,
              [](const Vector2& at) { return point_field(at, 50); });
}

TEST_CASE("flat mirror: the field of the image source, from any place of the source", "[long]") {
  const test::FlatMirror mirror(100, 300);
  const PointSource source({3, -4, 60}, power);
  check_field(mirror, source, 10, rings({0, 20, 40, 60}, 10), 2'000'000,
              [](const Vector2& at) { return point_field(at - Vector2(3, -4), 140); });
}

TEST_CASE("cone: the field of the ring of image sources") {
  const auto mirror = test::cone(60, 30, 40, 50);
  check_field(mirror, PointSource({0, 0, 45}, power), 6, rings({44, 56}, 6), 500'000,
              ConeField{60, 30, 40, 50, 45});
}

TEST_CASE("cylinder: the field after the rays have crossed the axis") {
  const auto mirror = test::cone(50, 30, 50, 40);
  check_field(mirror, PointSource({0, 0, 60}, power), 6, rings({14, 28, 42}, 6), 500'000,
              ConeField{50, 30, 50, 40, 60});
}

TEST_CASE("ellipsoid: all light passes the second focus") {
  for (double height : {60.0, 100.0, 1000.0}) {
    const double radius = 0.8 * height, focus = 0.6 * height;
    const auto mirror = test::half_ellipsoid(0, radius, height);
    const PointSource source({0, 0, focus}, power);
    const auto field = NearField::disc({0, 0, -focus}, {0, 0, 1}, 1e-3 * height);
    const auto traced = test::fly({source, mirror, {}, field}, photons(20'000), 0);
    CHECK(traced.counts.stored == traced.counts.met_mirror);
    CHECK(traced.counts.met_mirror >= 19'900);  // the map may waste 0.5 %
    double farthest = 0;
    for (const Crossing& crossing : traced.crossings)
      farthest = std::max(farthest, crossing.plane_mm().norm());
    CHECK(farthest < 1e-9);
  }
}

TEST_CASE("closed sphere: interactions are a geometric series") {
  const auto mirror = test::sphere(0, 50, -50);
  const PointSource source({10, 0, 20}, power);
  const auto field = NearField::disc({0, 0, -100}, {0, 0, 1}, 10);
  constexpr std::uint64_t count = 100'000;
  for (double reflectance : {0.3, 0.8, 0.95}) {
    const auto traced = test::fly({source, mirror, {reflectance, 0}, field}, photons(count), 0);
    CHECK(traced.energy.absorbed_w == Approx(power).epsilon(1e-12));
    // The first meeting is survived by all, with the power that survives: what follows is the series.
    const double mean = static_cast<double>(traced.counts.interactions) / count - 1;
    const double deviation = std::sqrt(reflectance / count) / (1 - reflectance);
    CHECK(test::plausible(test::normal_p((mean - 1 / (1 - reflectance)) / deviation)));
    const double wrong = reflectance + 0.03 * (1 - reflectance);  // 3 % less absorption
    CHECK(test::rejected(test::normal_p((mean - 1 / (1 - wrong)) / deviation)));
  }
}

TEST_CASE("sphere with a leak: the light that passes it is a geometric series too") {
  const auto mirror = test::sphere(0, 50, -50);
  const PointSource source({0, 0, 20}, power);
  const auto field = NearField::disc({0, 0, -1e5}, {0, 0, 1}, 10);
  constexpr double reflectance = 0.6, transmittance = 0.1, count = 100'000;
  const auto traced = test::fly({source, mirror, {reflectance, transmittance}, field},
                                photons(static_cast<std::uint64_t>(count)), 0);
  const double expected = transmittance / (1 - reflectance);
  const double deviation = std::sqrt(expected * (1 - expected) / count);
  CHECK(test::plausible(test::normal_p((traced.energy.escaped_w / power - expected) / deviation)));
}

TEST_CASE("a diffuse floor under a black dome: each photon that falls goes on to the dome") {
  const auto dome = test::half_ellipsoid(0, 50, 50);
  const PointSource source({0, 0, 20}, power);
  const auto floor = NearField::disc({0, 0, 0}, {0, 0, 1}, 50, Material::matt(1));
  constexpr double count = 100'000;
  const auto traced = test::fly({source, dome, {0, 0}, floor}, photons(static_cast<std::uint64_t>(count)), 0);
  CHECK(traced.energy.absorbed_w == Approx(power).epsilon(1e-12));
  CHECK(traced.counts.stored == 0);
  const double falls = 0.5 * (1 - 20 / std::hypot(20, 50));
  const double deviation = std::sqrt(falls * (1 - falls) / count);
  const double seen = static_cast<double>(traced.counts.interactions) / count - 1;
  CHECK(test::plausible(test::normal_p((seen - falls) / deviation)));
}

TEST_CASE("direct light: eq. 13 for tilted planes, dark behind the mirror and behind the sample") {
  const auto mirror = test::paraboloid();
  const PointSource source({0, 0, 50}, power);
  const auto field = NearField::disc({0, 0, 0}, {0, 0, 1}, 100);
  const Scene scene{source, mirror, {}, field};
  const auto direct = [&](const Vector3& point, const Vector3& normal) {
    return direct_field(scene, std::vector<FieldSample>{{point, normal.normalized()}})[0];
  };
  CHECK(direct({30, 40, 0}, {0, 0, 1}) == Approx(point_field({30, 40}, 50)));
  const Vector3 tilted = Vector3(-1, 0, 1).normalized();
  CHECK(direct({40, 0, 20}, tilted) == Approx(power / (4 * pi * 2500) * tilted.dot(Vector3(-0.8, 0, 0.6))));
  CHECK(direct({0, 0, 0}, {0, 0, -1}) == 0);
  CHECK(direct({0, 0, 0}, {1, 0, 0}) == 0);
  CHECK(direct({0, 0, 150}, {0, 0, -1}) == 0);  // behind the mirror
  CHECK(direct({150, 0, 55}, {-1, 0, 0}) == 0);
  CHECK(direct({150, 0, 45}, {-1, 0, 0}) > 0);  // below the rim
  CHECK(direct({0, 0, 50}, {0, 0, 1}) == 0);    // on the source: grazing
  CHECK(direct({80, 0, 84}, {-1, 0, 0}) == 0);  // just outside; the mirror is at z = 84 there
}
