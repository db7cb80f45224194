#include "sim/facet_field.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

#include "base/errors.h"
#include "base/units.h"
#include "sim/facet_estimate.h"
#include "sim/photon_fields.h"
#include "sim/simulation.h"
#include "support/faceted_surface.h"
#include "support/flat_mirror.h"
#include "support/statistics.h"

/// Fields made of facets, by fields of known shape.

using namespace catoptric;
using namespace catoptric::sim;

namespace {

std::shared_ptr<const FacetField> field_of(Facets&& facets, bool lit_front = true) {
  const auto shared = std::make_shared<const Facets>(std::move(facets));
  return std::make_shared<const FacetField>(std::make_shared<test::FacetedSurface>(shared), shared,
                                            lit_front);
}

Facets wall_facets() {
  Facets facets;
  test::add_parallelogram(facets, {25, -10, -15}, {0, 0, 30}, {0, 20, 0});  // it looks to -x
  return facets;
}

std::vector<FieldSample> on_field(std::vector<FieldSample> samples, std::size_t field) {
  for (FieldSample& sample : samples) sample.field = field;
  return samples;
}

std::vector<FieldSample> joined(std::vector<FieldSample> first, const std::vector<FieldSample>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

/// Flux on a field by the samples' mean.
double flux(const std::vector<double>& irradiance, double area_mm2) {
  return std::accumulate(irradiance.begin(), irradiance.end(), 0.0) / static_cast<double>(irradiance.size()) *
         area_mm2;
}

const PointSource lamp({3, 0, 0}, 2);
const test::FlatMirror mirror{20, 60};
const NearField nowhere = NearField::disc({0, 0, 900}, {0, 0, 1}, 1);

FieldEstimate light_on(const Surroundings& room, const std::vector<FieldSample>& samples,
                       const EstimateOptions& estimate, std::uint64_t photons = 200'000) {
  return simulate({lamp, mirror, {0.8, 0}, nowhere, &room}, samples, {photons, Sampler::random, 9}, estimate);
}

}  // namespace

TEST_CASE("a kernel's integral over facets is that of a disc, its half at an edge, its quarter at a corner") {
  const auto field = field_of(wall_facets());
  const double disc = pi * 2 * 2;
  for (const Kernel kernel :
       {Kernel::silverman, Kernel::epanechnikov, Kernel::cone, Kernel::gaussian, Kernel::constant}) {
    const double allowed = kernel == Kernel::constant ? 1e-2 : 1e-3;
    const auto share = [&](const Vector3& at) {
      return kernel_integral_mm2(*field, at, {-1, 0, 0}, kernel, 2) / disc;
    };
    INFO(name(kernel));
    CHECK(share({25, 1, 2}) == Approx(1).epsilon(allowed));
    CHECK(share({25, 10, 2}) == Approx(0.5).epsilon(allowed));
    CHECK(share({25, -10, 15}) == Approx(0.25).epsilon(allowed));
    CHECK(share({25, 30, 2}) == 0);
    CHECK(kernel_integral_mm2(*field, {25, 1, 2}, {1, 0, 0}, kernel, 2) == 0);  // from behind
  }
}

TEST_CASE("places on facets are uniform by area, on them, and their sheet coordinates lead back to them") {
  Facets facets = wall_facets();
  test::add_parallelogram(facets, {0, 0, 0}, {5, 0, 0}, {0, 4, 0});
  const auto field = field_of(std::move(facets));
  CHECK(field->area_mm2() == Approx(620));
  std::size_t on_wall = 0;
  double y_mm = 0;
  for (const auto& [point_mm, normal] : field->places(1240)) {
    const bool wall = point_mm.x() > 20;
    on_wall += wall;
    if (wall) y_mm += point_mm.y();
    CHECK(normal == (wall ? Vector3(-1, 0, 0) : Vector3(0, 0, 1)));
    const auto meeting = field->meet({point_mm + 3 * normal, -normal}, false, 10);
    REQUIRE(meeting);
    const Vector3 there = point_mm + (3 - meeting->distance_mm) * normal;
    CHECK((field->to_space(field->to_sheet(meeting->facet, there)) - there).norm() < 1e-12);
    CHECK(meeting->distance_mm == Approx(3).epsilon(1e-3));
  }
  CHECK(on_wall == 1200);
  CHECK(std::abs(y_mm / 1200) < 0.05);
}

TEST_CASE("a wall of facets sees what the same rectangle sees", "[threads]") {
  const NearField wall = NearField::rectangle({25, 0, 0}, {-1, 0, 0}, {0, 1, 0}, 20, 30);
  const Surroundings room({}, {{"wall", wall, 1}, {"facets", NearField::facets(field_of(wall_facets())), 1}});
  const std::vector<FieldSample> samples = wall.samples(60);
  const auto both = joined(on_field(samples, 1), on_field(samples, 2));
  for (const EstimateOptions& estimate :
       {EstimateOptions{Kernel::silverman, std::nullopt, 2.0}, EstimateOptions{Kernel::silverman, 150, {}}}) {
    const FieldEstimate light = light_on(room, both, estimate);
    const std::size_t n = samples.size();
    std::size_t dark = 0;
    for (std::size_t i = 0; i < n; ++i) {
      dark += light.reflected[i] == 0;
      CHECK(light.direct[n + i] == light.direct[i]);
      // An invisible rectangle also counts photons beyond its edge, where the facets end.
      const bool inside = std::abs(samples[i].point_mm.y()) < 8 && std::abs(samples[i].point_mm.z()) < 13;
      if (!inside || estimate.neighbours) continue;
      CHECK(light.reflected[n + i] == Approx(light.reflected[i]).epsilon(1e-3));
      CHECK(light.noise[n + i] == Approx(light.noise[i]).epsilon(1e-3));
    }
    CHECK(dark == 0);
    const std::vector<double> own(light.reflected.begin() + static_cast<std::ptrdiff_t>(n),
                                  light.reflected.end()),
        wanted(light.reflected.begin(), light.reflected.begin() + static_cast<std::ptrdiff_t>(n));
    CHECK(flux(own, 600) == Approx(flux(wanted, 600)).epsilon(0.02));
  }
}

TEST_CASE("all light that leaves goes through a sphere of facets about it, once and outwards") {
  const Vector3 centre{1, 2, 3};
  const auto sphere = [&](bool lit_front) {
    return NearField::facets(field_of(test::icosphere(centre, 100, 2), lit_front));
  };
  const Surroundings room({}, {{"inside", sphere(false), 1}, {"outside", sphere(true), 1}});
  const NearField inside = sphere(false);
  const auto samples = joined(on_field(inside.samples(400), 1), on_field(sphere(true).samples(400), 2));
  const FieldEstimate light = light_on(room, samples, {Kernel::silverman, std::nullopt, 15}, 10'000);
  const auto half = [](const std::vector<double>& all, std::ptrdiff_t first) {
    return std::vector<double>(all.begin() + first, all.begin() + first + 400);
  };
  const double reflected = flux(half(light.reflected, 0), inside.area_mm2());
  CHECK(flux(half(light.direct, 0), inside.area_mm2()) + reflected / 0.8 == Approx(2).epsilon(0.02));
  CHECK(reflected > 0.3);
  for (std::size_t i = 400; i < 800; ++i) CHECK((light.reflected[i] == 0 && light.direct[i] == 0));
}

TEST_CASE("a flight meets all that it crosses of an invisible body: as much leaves it as enters", "[long]") {
  const auto ball = [](bool lit_front) {
    return NearField::facets(field_of(test::icosphere({0, 0, -30}, 20, 2), lit_front));
  };
  const Surroundings room({}, {{"enters", ball(true), 1}, {"leaves", ball(false), 1}});
  const NearField one = ball(true);
  const auto samples = joined(on_field(one.samples(300), 1), on_field(ball(false).samples(300), 2));
  const FieldEstimate light = light_on(room, samples, {Kernel::silverman, std::nullopt, 3}, 40'000);
  const std::vector<double> enters(light.reflected.begin(), light.reflected.begin() + 300),
      leaves(light.reflected.begin() + 300, light.reflected.end());
  // The image of the lamp stands at z = 40.
  const double sine = 20 / Vector3(3, 0, 70).norm(), caught = 0.5 * (1 - std::sqrt(1 - sine * sine));
  CHECK(flux(enters, one.area_mm2()) == Approx(0.8 * 2 * caught).epsilon(0.06));
  CHECK(flux(enters, one.area_mm2()) == Approx(flux(leaves, one.area_mm2())).epsilon(0.05));
}

TEST_CASE("real facets stop light, scatter it and shade like rectangles, around a corner too") {
  const Material grey = Material::matt(0.6);
  Facets corner;
  test::add_parallelogram(corner, {25, -10, -15}, {0, 0, 30}, {0, 20, 0});
  test::add_parallelogram(corner, {25, -10, -15}, {0, 20, 0}, {-20, 0, 0});  // it looks up
  const NearField wall = NearField::rectangle({25, 0, 0}, {-1, 0, 0}, {0, 1, 0}, 20, 30, grey),
                  ground = NearField::rectangle({15, 0, -15}, {0, 0, 1}, {1, 0, 0}, 20, 20, grey),
                  beyond = NearField::rectangle({40, 0, 0}, {-1, 0, 0}, {0, 1, 0}, 20, 20);
  const Surroundings plain({}, {{"wall", wall, 1}, {"ground", ground, 1}, {"beyond", beyond, 1}}),
      faceted({},
              {{"corner", NearField::facets(field_of(std::move(corner)), grey), 1}, {"beyond", beyond, 1}});
  const auto walls = joined(wall.samples(24), ground.samples(24)), shaded = beyond.samples(24);
  auto plain_samples = joined(on_field(wall.samples(24), 1), on_field(ground.samples(24), 2));
  plain_samples = joined(plain_samples, on_field(shaded, 3));
  const std::size_t both = walls.size();
  auto lifted = on_field(walls, 1);
  for (FieldSample& sample : lifted) sample.point_mm += 1e-4 * sample.normal;
  const auto faceted_samples = joined(lifted, on_field(shaded, 2));
  const EstimateOptions estimate{Kernel::silverman, std::nullopt, 4};
  const FieldEstimate wanted = light_on(plain, plain_samples, estimate),
                      found = light_on(faceted, faceted_samples, estimate);
  REQUIRE(wanted.reflected.size() == found.reflected.size());
  std::vector<double> differences, noise;
  for (std::size_t i = 0; i < found.reflected.size(); ++i) {
    INFO(i);
    CHECK(found.direct[i] == Approx(wanted.direct[i]).epsilon(1e-4));
    differences.push_back(found.reflected[i] - wanted.reflected[i]);
    noise.push_back(std::hypot(found.noise[i], wanted.noise[i]));
    if (i < both) CHECK(found.reflected[i] > 0);
  }
  const std::vector<double> nothing(differences.size(), 0.0);
  CHECK(test::plausible(test::z_test_p(differences, nothing, noise)));
  CHECK(found.direct.back() == 0);  // behind the wall
  for (double& difference : differences) difference += 0.1 * wanted.reflected.front();
  CHECK(test::rejected(test::z_test_p(differences, nothing, noise)));
  CHECK(found.energy.stopped_w + found.energy.received_w ==
        Approx(wanted.energy.stopped_w + wanted.energy.received_w).epsilon(0.02));
}

TEST_CASE("facets without area are no field") {
  Facets line;
  line.points_mm = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  line.corners = {{0, 1, 2}};
  CHECK_THROWS_AS(field_of(std::move(line)), InputError);
}
