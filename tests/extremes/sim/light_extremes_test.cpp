#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "base/units.h"
#include "cad/engines.h"
#include "sim/simulation.h"
#include "support/analytic_reflectors.h"
#include "support/crossings.h"
#include "support/flat_mirror.h"

using namespace catoptric;
using namespace catoptric::sim;

namespace {

constexpr double power = pi / 100;

void check_sound(const FieldEstimate& got) {
  for (const auto* part : {&got.direct, &got.reflected, &got.noise, &got.kernel_radius_mm})
    CHECK(std::all_of(part->begin(), part->end(),
                      [](double each) { return std::isfinite(each) && each >= 0; }));
  const EnergyLedger& energy = got.energy;
  const double sum =
      energy.missed_w + energy.absorbed_w + energy.received_w + energy.escaped_w + energy.cut_off_w;
  CHECK(std::abs(sum - energy.emitted_w) <= 1e-12 * energy.emitted_w);
}

PhotonOptions photons(std::uint64_t count) { return {count, Sampler::sobol, 1, 0, 200}; }

}  // namespace

TEST_CASE("a source anywhere, even on the mirror, gives a sound field") {
  const auto mirror = test::paraboloid();
  const auto engine = cad::make_meridian_reflector(mirror.profile());
  const auto field = NearField::disc({0, 0, 0}, {0, 0, 1}, 100);
  const auto samples = field.samples(50);
  for (const Reflector* each :
       {static_cast<const Reflector*>(&mirror), static_cast<const Reflector*>(engine.get())})
    for (const Vector3& place :
         {Vector3(0, 0, 100), Vector3(100, 0, 50), Vector3(60, 0, 82), Vector3(0, 0, 0), Vector3(0, 0, 101),
          Vector3(0, 0, 1e8), Vector3(0, 0, -1e8), Vector3(1e8, 0, 0), Vector3(0, 0, 99.9999999999),
          Vector3(1e-300, 0, 50)}) {
      CAPTURE(each->engine(), place.transpose());
      const PointSource source(place, power);
      check_sound(
          simulate({source, *each, {0.9, 0}, field}, samples, photons(2000), {Kernel::silverman, 50, {}}));
    }
}

TEST_CASE("a near field anywhere: through the mirror, along the axis, far away, tiny") {
  const auto mirror = test::half_ellipsoid(50, 50, 80);
  const PointSource source({0, 0, 70}, power);
  for (const auto& material : {std::optional<Material>{}, std::optional<Material>{Material::matt(0.5, 0.3)}})
    for (const NearField& field :
         {NearField::disc({0, 0, 90}, {0, 0, 1}, 30, material),
          NearField::disc({0, 0, 70}, {0, 0, 1}, 30, material),
          NearField::disc({0, 0, 60}, {1, 0, 0}, 200, material),
          NearField::disc({0, 0, -1e8}, {0, 0, 1}, 1e8, material),
          NearField::disc({0, 0, 50}, {0, 0, 1}, 50, material),
          NearField::disc({1, 1, 10}, {0, 0, 1}, 1e-6, material),
          NearField::rectangle({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, 1e6, 1e-3, material)})
      for (const EstimateOptions& options :
           {EstimateOptions{Kernel::silverman, 50, {}}, EstimateOptions{Kernel::gaussian, {}, 5.0}})
        check_sound(
            simulate({source, mirror, {0.9, 0.05}, field}, field.samples(30), photons(2000), options));
}

TEST_CASE(
    "a field a million part sizes away: the paraboloid's beam keeps its width, the hemisphere's spreads") {
  const auto paraboloid = test::paraboloid();
  const PointSource source({0, 0, 50}, power);
  const auto far = NearField::disc({0, 0, -1e8}, {0, 0, 1}, 120);
  const auto beam = test::fly({source, paraboloid, {}, far}, photons(2000), 0);
  CHECK(beam.counts.stored == 2000);  // a ray error of 1e-13 moves it by 1e-5 mm
  const auto hemisphere = test::half_ellipsoid(50, 50, 50);
  const auto wide = NearField::disc({0, 0, -1e8}, {0, 0, 1}, 5e7);
  const auto samples = wide.samples(50);
  const auto got =
      simulate({source, hemisphere, {}, wide}, samples, photons(100'000), {Kernel::silverman, {}, 1e7});
  // kernel bias (r / distance)^2 of some units times 1e-2, Sobol noise below that of 1e3 photons, 4 %
  for (std::size_t i = 0; i < samples.size(); ++i)
    CHECK(got.reflected[i] == Approx(got.direct[i]).epsilon(0.06));
}

TEST_CASE("no power, one photon, no samples") {
  const auto mirror = test::paraboloid();
  const auto field = NearField::disc({0, 0, 0}, {0, 0, 1}, 100);
  const auto samples = field.samples(10);
  const EstimateOptions options{Kernel::silverman, 50, {}};
  const PointSource dark({0, 0, 50}, 0), bright({0, 0, 50}, 1e9);
  const auto none = simulate({dark, mirror, {}, field}, samples, photons(1000), options);
  check_sound(none);
  CHECK(std::all_of(none.reflected.begin(), none.reflected.end(), [](double each) { return each == 0; }));
  for (std::uint64_t count : {0u, 1u, 2u})
    check_sound(simulate({bright, mirror, {}, field}, samples, photons(count), options));
  CHECK(simulate({bright, mirror, {}, field}, {}, photons(10), options).reflected.empty());
}

TEST_CASE("a mirror seen edge-on, or flat in the source's own plane, wastes photons but breaks nothing") {
  const test::FlatMirror flat(50, 100);
  const auto field = NearField::disc({0, 0, 0}, {0, 0, 1}, 100);
  const PointSource level({0, 0, 50}, power), aside({300, 0, 50}, power);
  for (const PointSource* source : {&level, &aside})
    check_sound(
        simulate({*source, flat, {}, field}, field.samples(20), photons(1000), {Kernel::cone, {}, 10.0}));
  const auto thin = test::cone(1e-3, 0, 1e-3, 1e5);
  const PointSource below({0, 0, -1}, power);
  check_sound(simulate({below, thin, {}, field}, field.samples(20), photons(1000), {Kernel::cone, {}, 10.0}));
}

TEST_CASE("engine meridian gives the field of the closed-form mirror, photon for photon") {
  const PointSource source({0, 0, 50}, power), aside({20, 10, 40}, power);
  const auto field = NearField::disc({0, 0, 0}, {0, 0, 1}, 100);
  for (const auto& mirror : {test::paraboloid(), test::half_ellipsoid(50, 60, 80)}) {
    const auto engine = cad::make_meridian_reflector(mirror.profile());
    for (const PointSource* each : {&source, &aside}) {
      const auto a = test::fly({*each, mirror, {0.8, 0}, field}, photons(20'000), 50);
      const auto b = test::fly({*each, *engine, {0.8, 0}, field}, photons(20'000), 50);
      // a photon on the rim or on the recorded area's edge may fall either way
      CHECK(std::abs(static_cast<double>(a.counts.stored) - static_cast<double>(b.counts.stored)) <= 2);
      std::size_t i = 0, j = 0, compared = 0;
      double worst = 0;
      while (i < a.crossings.size() && j < b.crossings.size()) {
        if (a.crossings[i].photon() < b.crossings[j].photon()) {
          ++i;
        } else if (a.crossings[i].photon() > b.crossings[j].photon()) {
          ++j;
        } else {
          worst = std::max(worst, (a.crossings[i++].plane_mm() - b.crossings[j++].plane_mm()).norm());
          ++compared;
        }
      }
      CHECK(compared + 4 > a.crossings.size());
      // hits agree to 1e-12 of the part; bounces at grazing angles magnify that
      CHECK(worst < 1e-6);
    }
  }
}
