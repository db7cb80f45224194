#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>

#include "base/random_stream.h"
#include "base/units.h"
#include "cad/engines.h"
#include "sim/cylinder_source.h"
#include "sim/disc_source.h"
#include "sim/planner.h"
#include "sim/projection_map.h"
#include "sim/rectangle_source.h"
#include "sim/rings.h"
#include "sim/simulation.h"
#include "sim/sphere_source.h"
#include "support/analytic_reflectors.h"

using namespace catoptric;
using namespace catoptric::sim;

namespace {

struct Place {
  Vector3 at, axis;
};
const Place all_places[] = {{{0, 0, 50}, {0, 0, 1}},  {{0, 0, 30}, {0.2, 0, 1}},
                            {{0, 0, 80}, {0, 0, -1}}, {{20, 10, 60}, {0.3, 1, 0}},
                            {{0, 0, 45}, {1, 0, 0}},  {{-150, 0, 70}, {1, 0.2, 0.1}},
                            {{0, 0, 50}, {0, 0, -1}}};

std::vector<double> bits_of(const FieldEstimate& got) {
  std::vector<double> numbers = got.direct;
  numbers.insert(numbers.end(), got.reflected.begin(), got.reflected.end());
  numbers.push_back(got.energy.received_w);
  numbers.push_back(got.energy.missed_w);
  return numbers;
}

template <typename Run>
std::vector<double> with_threads(int threads, const Run& run) {
  tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  tbb::task_arena arena(threads);
  std::vector<double> numbers;
  arena.execute([&] { numbers = run(); });
  return numbers;
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

}  // namespace

TEST_CASE("no lit way from any point of a source to the mirror is left out") {
  const auto profile = Profile::bezier({{5, 100, 1}, {50, 100, 1.4}, {100, 50, 1}});
  for (const Place& place : all_places) {
    const LambertianDisc disc(place.at, 12, place.axis, 1);
    const PointSource point(place.at, 1, 0.7, place.axis);
    const ProjectionMap of_disc = disc.directions_to(profile), of_point = point.directions_to(profile);
    const Vector3 axis = place.axis.normalized();
    for (std::uint64_t i = 0; i < 20'000; ++i) {
      RandomStream stream(4, Purpose::test, i);
      const MeridianPoint on = profile.at(stream.uniform());
      const double azimuth = 2 * pi * stream.uniform();
      const Vector3 target(on.r_mm * std::cos(azimuth), on.r_mm * std::sin(azimuth), on.z_mm);
      const double first = stream.uniform(), second = stream.uniform();
      const Vector3 from = disc.emit(disc.all_directions(), {0.5, 0.5, first, second}).origin_mm;
      if ((target - from).normalized().dot(axis) > 1e-6) REQUIRE(of_disc.contains(target - from));
      if ((target - place.at).normalized().dot(axis) > 1e-6) REQUIRE(of_point.contains(target - place.at));
    }
  }
}

TEST_CASE("no lit way from any point of a sphere, cylinder or rectangle to the mirror is left out") {
  const auto profile = Profile::bezier({{5, 100, 1}, {50, 100, 1.4}, {100, 50, 1}});
  for (const Place& place : all_places) {
    const LambertianSphere sphere(place.at, 6, 1);
    const LambertianCylinder cylinder(place.at, place.axis, 2, 15, 1);
    const LambertianRectangle rectangle(place.at, place.axis, {0.3, 0.4, 0.5}, 14, 3, 1);
    for (const MappedSource* source :
         std::initializer_list<const MappedSource*>{&sphere, &cylinder, &rectangle}) {
      const ProjectionMap map = source->directions_to(profile), all = source->all_directions();
      CHECK(source->power_into_w(map) <= 1 + 1e-12);
      for (std::uint64_t i = 0; i < 4'000; ++i) {
        RandomStream stream(4, Purpose::test, i);
        const MeridianPoint on = profile.at(stream.uniform());
        const double azimuth = 2 * pi * stream.uniform();
        const Vector3 target(on.r_mm * std::cos(azimuth), on.r_mm * std::sin(azimuth), on.z_mm);
        std::array<double, 4> numbers;
        for (double& number : numbers) number = stream.uniform();
        const Ray ray = source->emit(all, numbers);
        const Vector3 way = (target - ray.origin_mm).normalized();
        // Only a sphere's normal is known here; the others' directions are those of their law.
        const bool lit = source->intensity_w_per_sr(way) > 1e-6 &&
                         (source != &sphere || way.dot(ray.origin_mm - place.at) > 1e-6);
        if (lit) REQUIRE(map.contains(way));
      }
    }
  }
}

TEST_CASE("the ledger adds up for sources with an axis, and no more is emitted than there is") {
  const auto mirror = test::half_ellipsoid(50, 50, 80);
  for (const Place& place : all_places)
    for (const auto& surface :
         {std::optional<Material>{}, std::optional<Material>{Material::matt(0.5, 0.2)}}) {
      const auto field = NearField::disc({0, 0, 20}, {0, 0, 1}, 40, surface);
      const LambertianDisc disc(place.at, 3, place.axis, 3.7);
      const PointSource point(place.at, 3.7, 2.5, place.axis);
      for (const Source* source : {static_cast<const Source*>(&disc), static_cast<const Source*>(&point)}) {
        const EnergyLedger energy =
            trace_photons(Scene{*source, mirror, {0.7, 0.1}, field}, {5000, Sampler::sobol, 3, 4, 50}, 5)
                .energy;
        CHECK(energy.emitted_w <= 3.7 * (1 + 1e-12));
        CHECK(energy.missed_w + energy.absorbed_w + energy.received_w + energy.escaped_w + energy.cut_off_w ==
              Approx(energy.emitted_w).epsilon(1e-12));
      }
    }
}

TEST_CASE("1, 2 and 7 threads give the same bits with a disc and with a tilted point", "[threads]") {
  const auto mirror = test::half_ellipsoid(50, 50, 80);
  const auto field = NearField::disc({0, 0, 20}, {0.1, 0, 1}, 40);
  const auto samples = field.samples(200);
  const LambertianDisc disc({2, 0, 60}, 4, {0.1, 0, -1}, 1);
  const PointSource point({0, 0, 60}, 1, 3, {0.1, 0, -1});
  for (const Source* source : {static_cast<const Source*>(&disc), static_cast<const Source*>(&point)}) {
    const auto run = [&] {
      return bits_of(simulate(Scene{*source, mirror, {0.7, 0.1}, field}, samples,
                              {10'001, Sampler::sobol, 3, 4, 50}, {Kernel::silverman, {}, 6.0}));
    };
    const auto one = with_threads(1, run);
    CHECK(same_bits(one, with_threads(2, run)));
    CHECK(same_bits(one, with_threads(7, run)));
  }
}

TEST_CASE("photons of an upright point have the same fates in their planes and in space") {
  const auto mirror =
      cad::make_meridian_reflector(Profile::bezier({{0, 100, 1}, {50, 100, 1.4}, {100, 50, 1}}));
  const auto field = NearField::disc({0, 0, 0}, {0, 0, 1}, 60);
  for (const double exponent : {0.5, 1.0, 50.0}) {
    const PointSource source({0, 0, 50}, 1, exponent);
    const Scene scene{source, *mirror, {0.9, 0}, field};
    const auto fly = [&](FlightSpace space) {
      return PhotonFlights(scene, RecordedArea::about(field, 0), space)
          .fly({20'000, Sampler::random, 3, 4, 50}, [](auto, auto&&) {});
    };
    const FlightTotals plane = fly(FlightSpace::as_needed), whole = fly(FlightSpace::always_space);
    CHECK(plane.counts.stored == whole.counts.stored);
    CHECK(plane.counts.met_mirror == whole.counts.met_mirror);
    CHECK(plane.energy.received_w == whole.energy.received_w);
  }
}

TEST_CASE("the planner knows which rung lights a source with an axis, and says what it models") {
  const auto mirror =
      cad::make_meridian_reflector(Profile::bezier({{0, 100, 1}, {50, 100, 1}, {100, 50, 1}}));
  const auto field = NearField::disc({0, 0, 0}, {0, 0, 1}, 60);
  const EstimateOptions fixed{Kernel::silverman, {}, 5.0};
  const auto plan = [&](const Source& source) {
    return make_plan({source, *mirror, {}, field}, {fixed, {}, {}});
  };
  const LambertianDisc disc({0, 0, 50}, 5, {0, 0, 1}, 1);
  const Plan of_disc = plan(disc);
  CHECK(of_disc.rung == Rung::rings);
  std::string said;
  for (const Finding& finding : of_disc.findings)
    said += finding.feature + finding.found + finding.consequence;
  CHECK_THAT(said, Catch::Contains("Lambertian disc") && Catch::Contains("the source is extended") &&
                       Catch::Contains("stands in no light's way"));
  CHECK(plan(LambertianDisc({1, 0, 50}, 5, {0, 0, 1}, 1)).rung == Rung::photons);
  CHECK(plan(LambertianDisc({0, 0, 50}, 5, {0.1, 0, 1}, 1)).rung == Rung::photons);
  CHECK(plan(PointSource({0, 0, 50}, 1, 2)).rung == Rung::tubes);
  CHECK(plan(PointSource({0, 0, 50}, 1, 2, {0, 0, -1})).rung == Rung::tubes);
  CHECK(plan(PointSource({0, 0, 50}, 1, 2, {0.1, 0, 1})).rung == Rung::photons);
  CHECK_THROWS_WITH(make_plan({disc, *mirror, {}, field}, {fixed, Rung::tubes, {}}),
                    Catch::Contains("the source is extended"));
}
