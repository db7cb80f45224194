#include "sim/rings.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "base/units.h"
#include "cad/engines.h"
#include "sim/simulation.h"
#include "support/analytic_reflectors.h"
#include "support/statistics.h"

using namespace catoptric;
using namespace catoptric::sim;

namespace {

constexpr double power = pi / 100;
const Profile paper_profile = Profile::bezier({{0, 100, 1}, {50, 100, 1}, {100, 50, 1}});
const PointSource source({0, 0, 50}, power);
const auto field = NearField::disc({0, 0, 0}, {0, 0, 1}, 100);

/// Eq. 12, W/mm^2; its second and fourth derivatives by s = r^2 are 6 / 1e8 and 120 / 1e16 W/m^2 at most.
double eq12(double r) {
  const double t = 1 + r * r / 10'000;
  return r <= 100 ? power / (4 * pi * 2500 * t * t) : 0;
}

double point_field(double r) { return power * 50 / (4 * pi * std::pow(r * r + 2500, 1.5)); }

RingsOptions options(std::uint64_t photons, Sampler sampler = Sampler::sobol, std::uint64_t stream = 0) {
  RingsOptions made;
  made.photons = {photons, sampler, 1, stream, 1000};
  return made;
}

std::vector<double> radii_of(const NearField& patch, std::size_t count) {
  std::vector<double> radii;
  for (const FieldSample& sample : patch.samples(count)) radii.push_back(sample.point_mm.head<2>().norm());
  return radii;
}

template <typename Field>
double rmse(const std::vector<double>& got, const std::vector<double>& radii, const Field& truth) {
  double sum = 0;
  for (std::size_t i = 0; i < radii.size(); ++i) sum += std::pow(to_w_per_m2(got[i] - truth(radii[i])), 2);
  return std::sqrt(sum / static_cast<double>(radii.size()));
}

}  // namespace

TEST_CASE("rings: ten thousand photons give the paper's disc, its sharp rim included, within 1e-3 W/m2") {
  const auto mirror = cad::make_meridian_reflector(paper_profile);
  const auto radii = radii_of(field, 1024);
  for (std::uint64_t stream = 0; stream < 20; ++stream) {
    const auto got =
        rings_field({source, *mirror, {}, field}, radii, options(10'000, Sampler::sobol, stream));
    CHECK(rmse(got.irradiance, radii, eq12) < 1e-3);
    REQUIRE(got.edges_mm.size() == 1);
    CHECK(got.edges_mm[0] == Approx(100).epsilon(1e-13));
    // wrong twin: without the edge the rim is blurred, by a quarter W/m^2 over a bandwidth
    auto blurred = options(10'000, Sampler::sobol, stream);
    blurred.edges_mm.emplace();
    CHECK(rmse(rings_field({source, *mirror, {}, field}, radii, blurred).irradiance, radii, eq12) > 5e-3);
  }
}

TEST_CASE("rings: bias of second and of fourth order on the axis, inside and at the rim", "[long]") {
  const auto mirror = cad::make_meridian_reflector(paper_profile);
  const std::vector<double> radii{0, 60, 99.999'999};
  auto given = options(1'000'000);
  given.storage = RingStorage::sorted;  // bins would leave a noise of a tenth of the bias at the rim
  for (RingKernel kernel : {RingKernel::biweight, RingKernel::epanechnikov}) {
    given.kernel = kernel;
    std::vector<RingsField> fields;
    for (double bandwidth : {800.0, 1600.0}) {
      given.bandwidth_mm2 = bandwidth;
      fields.push_back(rings_field({source, *mirror, {}, field}, radii, given));
    }
    for (std::size_t i = 0; i < radii.size(); ++i) {
      const double narrow = fields[0].irradiance[i] - eq12(radii[i]);
      const double wide = fields[1].irradiance[i] - eq12(radii[i]);
      // Leading term h^2, the next one smaller by h E'''/E'' = 0.16 * 4 (one-sided) at most: ratio 4 within
      // 20 %.
      CHECK(wide / narrow == Approx(4).epsilon(0.2));
      // the fourth-order estimate tells the bias but for its own, h^2 E''''/E'' = 0.05 of it, and its noise
      CHECK(fields[0].bias[i] == Approx(narrow).epsilon(0.1));
      CHECK(std::abs(fields[0].debiased[i] - eq12(radii[i])) < 0.1 * std::abs(narrow));
    }
  }
}

TEST_CASE("rings: estimates up to a jump read the closed form within noise, beyond it nothing", "[long]") {
  // In space, with a mirror that leans on no engine and photons at random; so wide a field that the rim is
  // inside. The bandwidth's bias, 0.07 h^2 E'' < 1e-4 W/m^2 (one-sided 0.03), is far below the noise.
  const auto mirror = test::paraboloid();
  const auto wide = NearField::disc({0, 0, 0}, {0, 0, 1}, 150);
  const std::vector<double> radii{0, 20, 40, 60, 80, 90, 99.99, 100.01, 120, 150};
  auto given = options(2'000'000, Sampler::random);
  given.bandwidth_mm2 = 100;
  given.replicates = 16;
  const auto got = rings_field({source, mirror, {}, wide}, radii, given);
  std::vector<double> values, expected, noise, stronger;
  for (std::size_t i = 0; i < 7; ++i) {
    values.push_back(got.irradiance[i]);
    expected.push_back(eq12(radii[i]));
    stronger.push_back(1.05 * expected.back());
    noise.push_back(got.poisson_noise[i]);
  }
  CHECK(test::plausible(test::z_test_p(values, expected, noise)));
  CHECK(test::rejected(test::z_test_p(values, stronger, noise)));
  for (std::size_t i = 7; i < radii.size(); ++i) CHECK(got.irradiance[i] == 0);
}

TEST_CASE("rings: sphere of start C, every ray returns through the source") {
  const auto mirror = test::half_ellipsoid(50, 50, 50);
  const auto narrow = NearField::disc({0, 0, 0}, {0, 0, 1}, 60);
  const auto radii = radii_of(narrow, 100);
  const auto got = rings_field({source, mirror, {}, narrow}, radii, options(1'000'000));
  CHECK(got.edges_mm.empty());  // the rim's rays are level
  // E'' by s at the centre is 15/4 E / 2500^2: the field's own scale is 50 mm as the paraboloid's is 100, so
  // that the RMSE of 1e6 photons is some 3e-4 in place of 6e-5
  CHECK(rmse(got.irradiance, radii, point_field) < 1e-3);
  for (std::size_t i = 0; i < radii.size(); ++i)
    CHECK(std::abs(got.debiased[i] - point_field(radii[i])) <
          12 * got.debiased_noise[i] + from_w_per_m2(1e-4));
}

TEST_CASE("rings: a conical band lights a ring with two sharp edges") {
  // As ConeField in closed_forms_test: a ring of image sources.
  const auto mirror = test::cone(60, 30, 40, 50);
  const PointSource low({0, 0, 45}, power);
  const auto truth = [](double r) {
    const double nr = 20, nz = 20, length = std::hypot(nr, nz);
    const double gap = ((0 - 60) * nr + (45 - 30) * nz) / length;
    const double image_r = -2 * gap * nr / length, image_z = 45 - 2 * gap * nz / length;
    double sum = 0;
    for (const double landing : {r, -r}) {
      const double dr = landing - image_r, dz = -image_z;
      const double share = ((60 - image_r) * nr + (30 - image_z) * nz) / (dr * nr + dz * nz);
      const double mirror_r = image_r + share * dr, mirror_z = image_z + share * dz;
      if (!(share > 0 && share < 1 && mirror_z >= 30 && mirror_z <= 50)) continue;
      const double way = std::hypot(dr, dz), sine = mirror_r / std::hypot(mirror_r, mirror_z - 45);
      sum += power * sine * (std::abs(dz) / way) / (4 * pi * r * way);
    }
    return sum;
  };
  const auto wide = NearField::disc({0, 0, 0}, {0, 0, 1}, 100);
  const std::vector<double> probe{0};
  const auto edges = rings_field({low, mirror, {}, wide}, probe, options(1000)).edges_mm;
  REQUIRE(edges.size() == 2);
  std::vector<double> radii;
  for (int i = 0; i <= 20; ++i) radii.push_back(edges[0] + 1e-6 + (edges[1] - edges[0] - 2e-6) * i / 20.0);
  const auto got = rings_field({low, mirror, {}, wide}, radii, options(500'000));
  for (std::size_t i = 0; i < radii.size(); ++i) {
    CAPTURE(radii[i]);
    CHECK(truth(radii[i]) > 0);
    CHECK(std::abs(got.irradiance[i] - truth(radii[i])) < 12 * got.noise[i] + 2 * std::abs(got.bias[i]));
    CHECK(got.irradiance[i] == Approx(truth(radii[i])).epsilon(0.01));
  }
  const std::vector<double> dark{edges[0] - 0.01, edges[1] + 0.01};
  for (double value : rings_field({low, mirror, {}, wide}, dark, options(500'000)).irradiance)
    CHECK(value == 0);
}

TEST_CASE("rings and photons agree, several bounces, absorption and a real field included", "[long]") {
  const auto mirror = cad::make_meridian_reflector(Profile::bezier({{0, 100, 1}, {70, 100, 1}, {60, 20, 1}}));
  const PointSource low({0, 0, 35}, power);
  for (const auto& material :
       {std::optional<Material>{}, std::optional<Material>{Material::matt(0.4, 0.2)}}) {
    const auto patch = NearField::disc({0, 0, 0}, {0, 0, 1}, 80, material);
    const Scene scene{low, *mirror, {0.8, 0.05}, patch};
    std::vector<FieldSample> samples;
    std::vector<double> radii;
    for (double r : {20.0, 40.0, 60.0}) {
      samples.push_back({{0, r, 0}, {0, 0, 1}});
      radii.push_back(r);
    }
    const PhotonOptions photons{1'000'000, Sampler::random, 1, 9, 1000};
    const auto space = simulate(scene, samples, photons, {Kernel::silverman, {}, 4.0});
    auto given = options(1'000'000, Sampler::random);
    given.bandwidth_mm2 = 150;
    const auto rings = rings_field(scene, radii, given);
    for (std::size_t i = 0; i < radii.size(); ++i) {
      const double noise = std::hypot(space.noise[i], rings.poisson_noise[i]);
      // the photons' own kernel adds r^2 / 16 of the Laplacian, here below 2 % of the field
      CHECK(std::abs(rings.irradiance[i] - space.reflected[i]) < 5 * noise + 0.02 * space.reflected[i]);
    }
    CHECK(rings.counts.interactions > rings.counts.met_mirror);
  }
}

TEST_CASE("rings: in the plane and in space the same photons have the same fates") {
  const auto mirror = cad::make_meridian_reflector(Profile::bezier({{0, 100, 1}, {70, 100, 1}, {60, 20, 1}}));
  const PointSource low({0, 0, 35}, power);
  for (const auto& material : {std::optional<Material>{}, std::optional<Material>{Material::matt(0, 0.3)}}) {
    const auto patch = NearField::disc({0, 0, 0}, {0, 0, -1}, 80, material);
    const auto radii = radii_of(patch, 50);
    auto given = options(20'000, Sampler::random);
    given.bandwidth_mm2 = 300;
    given.front = false;
    given.storage = RingStorage::sorted;
    const auto plane = rings_field({low, *mirror, {0.8, 0.1}, patch}, radii, given);
    given.in_plane = false;
    const auto space = rings_field({low, *mirror, {0.8, 0.1}, patch}, radii, given);
    CHECK(plane.counts.stored == space.counts.stored);
    CHECK(plane.counts.interactions == space.counts.interactions);
    CHECK(plane.energy.received_w == space.energy.received_w);
    CHECK(plane.energy.absorbed_w == space.energy.absorbed_w);
    for (std::size_t i = 0; i < radii.size(); ++i)
      CHECK(plane.irradiance[i] == Approx(space.irradiance[i]).epsilon(1e-9).margin(1e-15));
  }
}

TEST_CASE("rings: the near field may be any patch in the plane, the light is the same") {
  const auto mirror = cad::make_meridian_reflector(paper_profile);
  const std::vector<double> radii{10, 50, 70};
  auto given = options(50'000, Sampler::random);
  given.bandwidth_mm2 = 300;
  given.storage = RingStorage::sorted;
  const auto disc = rings_field({source, *mirror, {}, field}, radii, given);
  const auto rectangle = NearField::rectangle({40, 10, 0}, {0, 0, 1}, {1, 2, 0}, 60, 20);
  const auto aside = rings_field({source, *mirror, {}, rectangle}, radii, given);
  for (std::size_t i = 0; i < radii.size(); ++i)
    CHECK(aside.irradiance[i] == Approx(disc.irradiance[i]).epsilon(1e-9));
  CHECK(aside.energy.received_w < 0.5 * disc.energy.received_w);  // the rectangle's own light
}

TEST_CASE("rings: counted photons read as sorted ones within what a bin may do", "[long]") {
  const auto mirror = cad::make_meridian_reflector(paper_profile);
  const auto radii = radii_of(field, 200);
  auto given = options(1'000'000);
  given.bandwidth_mm2 = 600;
  const auto counted = rings_field({source, *mirror, {}, field}, radii, given);
  given.storage = RingStorage::sorted;
  const auto sorted = rings_field({source, *mirror, {}, field}, radii, given);
  // A bin of h/16: variance h^2 / 3072 more than the kernel's h^2 / 7, so 0.23 % of the bias, one-sided up to
  // ten times as much of it; and a photon moves by half a bin, which changes the noise by a part of itself.
  double difference = 0, bias = 0, noise = 0;
  for (std::size_t i = 0; i < radii.size(); ++i) {
    difference += std::pow(counted.irradiance[i] - sorted.irradiance[i], 2);
    bias += std::pow(sorted.bias[i], 2);
    noise += std::pow(sorted.noise[i], 2);
  }
  CHECK(std::sqrt(difference) < 0.03 * std::sqrt(bias) + std::sqrt(noise));
  given.storage = RingStorage::counted;
  given.bins = 4096;
  const auto few = rings_field({source, *mirror, {}, field}, radii, given);
  given.photons.photons = 2'000'000;
  CHECK(rings_field({source, *mirror, {}, field}, radii, given).memory_bytes == few.memory_bytes);
}
