#include <catch2/catch.hpp>
#include <cmath>

#include "base/units.h"
#include "cad/engines.h"
#include "sim/rings.h"
#include "sim/scatter.h"
#include "support/crossings.h"
#include "support/flat_mirror.h"
#include "support/quadrature.h"
#include "support/statistics.h"

/// Photons from mirrors that are not level or not smooth, against integrals of their own.

using namespace catoptric;
using namespace catoptric::sim;

namespace {

const PointSource focus({0, 0, 50}, pi / 100);

/// Photons that cross the near field's plane by rings of equal width, and one place for the others.
std::vector<double> ring_counts(const test::Flown& flown, double width_mm, std::size_t rings) {
  std::vector<double> counts(rings + 1, 0);
  for (const Crossing& crossing : flown.crossings) {
    const auto ring = static_cast<std::size_t>(crossing.plane_mm().norm() / width_mm);
    if (ring < rings) counts[ring] += 1;
  }
  counts[rings] = static_cast<double>(flown.counts.emitted);
  for (std::size_t i = 0; i < rings; ++i) counts[rings] -= counts[i];
  return counts;
}

/// The same of powers.
std::vector<double> ring_expectations(const test::Flown& flown, std::vector<double> power_w) {
  double others = static_cast<double>(flown.counts.emitted);
  for (double& each : power_w) others -= each /= flown.photon_power_w;
  power_w.push_back(others);
  return power_w;
}

/// A mirror whose reflectance turns up and down with the angle.
Material wavy() { return Material::with_table({0, 0.3, 0.5, 0.7}, {0.9, 0.5, 0.7, 0.2}); }

Material falling() { return Material::with_table({0, 0.8}, {0.9, 0.5}); }

/// Paper eq. 12 times the reflectance at the incidence, whose tangent on a paraboloid is r / 2 a.
double by_formula(const Material& material, double r) {
  const double square = 1 + r * r / 10'000;
  return material.reflectance_at(1 / std::sqrt(square)) * focus.power_w() / (4 * pi * 2500 * square * square);
}

Profile paraboloid() { return Profile::bezier({{0, 100, 1}, {50, 100, 1}, {100, 50, 1}}); }

/// Power of the light of a flat mirror at height 50 with radius 40 on a ring of the plane z = 0, from a point
/// on the axis at `source_z`: what the distribution sends from every place of the one to every place of the
/// other.
double flat_mirror_power(const Material& material, const Source& source, double inner, double outer) {
  const Vector3 up(0, 0, 1), from = source.position_mm();
  return test::integral(0, 40, 3, [&](double r) {
    const Vector3 place(r, 0, 50), way = place - from;
    const double distance = way.norm();
    const Vector3 in = way / distance;
    const double irradiance = source.intensity_w_per_sr(in) * in.z() / (distance * distance);
    return 2 * pi * r * irradiance * test::integral(inner, outer, 1, [&](double rho) {
             return 2 * rho * test::integral(0, pi, 4, [&](double azimuth) {
                      const Vector3 on = Vector3(rho * std::cos(azimuth), rho * std::sin(azimuth), 0) - place;
                      const double length = on.norm(), cosine = 50 / length;
                      return bsdf(material, in, on / length, up) * cosine * cosine / (length * length);
                    });
           });
  });
}

}  // namespace

TEST_CASE("photons of a paraboloid carry the reflectance at their own incidence", "[long]") {
  const auto mirror = cad::make_meridian_reflector(paraboloid());
  const auto field = NearField::disc({0, 0, 0}, {0, 0, 1}, 100);
  constexpr std::size_t rings = 10;
  std::uint64_t stream = 0;
  for (const Material& material : {falling(), wavy()})
    for (const FlightSpace space : {FlightSpace::as_needed, FlightSpace::always_space}) {
      const auto flown = test::fly({focus, *mirror, material, field},
                                   {300'000, Sampler::random, 5, stream++, 100}, 0, space);
      const auto want = [&](const Material& assumed) {
        std::vector<double> power;
        for (std::size_t i = 0; i < rings; ++i)
          power.push_back(test::integral(10.0 * static_cast<double>(i), 10.0 * static_cast<double>(i + 1), 8,
                                         [&](double r) { return 2 * pi * r * by_formula(assumed, r); }));
        return ring_expectations(flown, std::move(power));
      };
      const auto counts = ring_counts(flown, 10, rings);
      CHECK(test::plausible(test::chi_square_p(counts, want(material))));
      // wrong twin: the same light lost at every angle
      double mean = 0;
      for (std::size_t i = 0; i < rings; ++i)
        mean += counts[i] * flown.photon_power_w / (0.5 * focus.power_w());
      CHECK(test::rejected(test::chi_square_p(counts, want(Material{mean, 0}))));
    }
}

TEST_CASE("rings of a paraboloid carry the reflectance at their own incidence") {
  const auto mirror = cad::make_meridian_reflector(paraboloid());
  const auto field = NearField::disc({0, 0, 0}, {0, 0, 1}, 100);
  const std::vector<double> radii{0, 20, 40, 65, 90};
  const Material material = falling();
  for (const bool in_plane : {true, false}) {
    RingsOptions options;
    options.photons = {600'000, Sampler::random, 8, in_plane ? 1u : 2u, 100};
    options.replicates = 60;
    options.bandwidth_mm2 = 500;
    options.in_plane = in_plane;
    const RingsField got = rings_field({focus, *mirror, material, field}, radii, options);
    std::vector<double> want, head_on;
    for (const double r : radii) {
      want.push_back(by_formula(material, r));
      head_on.push_back(by_formula({material.reflectance_at(1), 0}, r));
    }
    CHECK(test::plausible(test::z_test_p(got.debiased, want, got.debiased_noise)));
    CHECK(test::rejected(test::z_test_p(got.debiased, head_on, got.debiased_noise)));
  }
}

TEST_CASE("a rough and matt flat mirror lights a plane as its distribution says", "[long]") {
  const test::FlatMirror mirror(50, 40);
  const auto field = NearField::disc({0, 0, 0}, {0, 0, 1}, 100);
  const PointSource source({0, 0, 20}, 3);
  constexpr std::size_t rings = 8;
  constexpr double width_mm = 12;
  Material metal = Material::metal(1.1, 2);
  metal.roughness = 0.25;
  std::uint64_t stream = 0;
  for (const Material& material : {Material{0.6, 0, 0.3, 0.3}, Material{1, 0, 0, 0.6}, metal}) {
    const auto flown =
        test::fly({source, mirror, material, field}, {200'000, Sampler::random, 6, stream++, 100}, 0);
    const auto want = [&](const Material& assumed) {
      std::vector<double> power;
      for (std::size_t i = 0; i < rings; ++i)
        power.push_back(flat_mirror_power(assumed, source, width_mm * static_cast<double>(i),
                                          width_mm * static_cast<double>(i + 1)));
      return ring_expectations(flown, std::move(power));
    };
    const auto counts = ring_counts(flown, width_mm, rings);
    CAPTURE(material.roughness);
    CHECK(test::plausible(test::chi_square_p(counts, want(material))));
    Material twin = material;
    twin.roughness *= 1.1;
    CHECK(test::rejected(test::chi_square_p(counts, want(twin))));
  }
}
