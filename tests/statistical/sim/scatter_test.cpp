#include "sim/scatter.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>

#include "base/units.h"
#include "sim/microfacets.h"
#include "support/quadrature.h"
#include "support/statistics.h"

using namespace catoptric;
using namespace catoptric::sim;

namespace {

const Vector3 up(0, 0, 1);

double degrees(double value) { return value * pi / 180; }

Vector3 polar(double sine, double cosine, double azimuth) {
  return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

/// Travels down towards the surface z = 0, from azimuth pi.
Vector3 incoming(double incidence_rad) { return polar(std::sin(incidence_rad), -std::cos(incidence_rad), 0); }

/// Share of the light that the glossy lobe sends on, by quadrature over the microfacets' normals that send it
/// above the surface: the slope's own scale is alpha, so that no lobe is too narrow for it.
double glossy_albedo(const Material& material, double incidence_rad) {
  const Vector3 in = incoming(incidence_rad), from = -in;
  const double alpha = material.roughness;
  // tan = alpha t / (1 - t) covers all tilts; two halves of the azimuth are alike.
  return 2 * test::integral(0, 1, 24, [&](double t) {
           const double tangent = alpha * t / (1 - t), stretch = alpha / ((1 - t) * (1 - t));
           const double cosine = 1 / std::hypot(1.0, tangent), sine = tangent * cosine;
           return test::integral(0, pi, 24, [&](double azimuth) {
             const Vector3 facet = polar(sine, cosine, azimuth);
             const double facing = from.dot(facet);
             if (!(facing > 0)) return 0.0;
             const Vector3 out = 2 * facing * facet - from;
             if (!(out.z() > 0)) return 0.0;
             // d(out) = 4 facing d(facet); d(facet) = sine d(angle), d(angle) = cosine^2 d(tangent)
             return bsdf(material, in, out, up) * out.z() * 4 * facing * sine * cosine * cosine * stretch;
           });
         });
}

/// Directions by cells: 8 bands of equal solid angle and 16 azimuths, and one for what does not go on.
constexpr std::size_t bands = 8, columns = 16;
std::size_t cell(const Vector3& out) {
  const auto band = std::min(bands - 1, static_cast<std::size_t>(out.z() * bands));
  const double azimuth = std::atan2(out.y(), out.x()) / (2 * pi) + 0.5;
  return 1 + columns * band + std::min(columns - 1, static_cast<std::size_t>(azimuth * columns));
}

/// What the reflectance distribution says of the cells, for so many photons.
std::vector<double> expected(const Material& material, const Vector3& in, int photons) {
  std::vector<double> all(1 + bands * columns, 0);
  double sum = 0;
  for (std::size_t band = 0; band < bands; ++band)
    for (std::size_t column = 0; column < columns; ++column) {
      const double low = static_cast<double>(band) / bands, step = 2 * pi / columns;
      const double share = test::integral(low, low + 1.0 / bands, 4, [&](double cosine) {
        const double first = (static_cast<double>(column) - 0.5 * columns) * step;
        return test::integral(first, first + step, 4, [&](double azimuth) {
          const Vector3 out = polar(std::sqrt(1 - cosine * cosine), cosine, azimuth);
          return bsdf(material, in, out, up) * cosine;
        });
      });
      all[1 + columns * band + column] = photons * share;
      sum += photons * share;
    }
  all[0] = photons - sum;
  return all;
}

/// Cells that expect few photons are joined with the first.
double chi_square_joined(const std::vector<double>& counts, const std::vector<double>& want) {
  std::vector<double> got{0}, due{0};
  for (std::size_t i = 0; i < want.size(); ++i) {
    const bool enough = want[i] > 10;
    if (enough) got.push_back(counts[i]), due.push_back(want[i]);
    if (!enough) got[0] += counts[i], due[0] += want[i];
  }
  if (due[0] < 10) {
    got[1] += got[0], due[1] += due[0];
    got.erase(got.begin()), due.erase(due.begin());
  }
  return test::chi_square_p(got, due);
}

template <typename Draw>
std::vector<double> counted(int photons, std::uint64_t seed, const Draw& draw) {
  std::vector<double> counts(1 + bands * columns, 0);
  for (int i = 0; i < photons; ++i) {
    RandomStream stream(seed, Purpose::test, static_cast<std::uint64_t>(i));
    const Scattered after = draw(stream);
    counts[after.interaction == Interaction::reflected ? cell(after.direction) : 0] += 1;
  }
  return counts;
}

}  // namespace

TEST_CASE("scattered directions follow the reflectance distribution", "[long]") {
  constexpr int photons = 200'000;
  Material metal = Material::metal(0.2, 3.4), table = Material::with_table({0, 1, 1.5}, {0.9, 0.3, 0.8});
  metal.roughness = 0.6;
  table.roughness = 0.3;
  const Material mixed{0.5, 0.15, 0.3, 0.4};
  std::uint64_t seed = 20;
  for (const Material& material : {Material{1, 0, 0, 0.2}, Material{1, 0, 0, 1}, metal, table, mixed})
    for (const double incidence : {0.0, 35.0, 75.0}) {
      const Vector3 in = incoming(degrees(incidence));
      const auto want = expected(material, in, photons);
      CAPTURE(material.roughness, incidence);
      CHECK(test::plausible(chi_square_joined(counted(photons, ++seed,
                                                      [&](RandomStream& stream) {
                                                        return scatter(material, Roulette::all, in,
                                                                       Vector3(-up), stream);
                                                      }),
                                              want)));
    }
}

TEST_CASE("normals drawn by D cos instead of those that are seen are found out") {
  constexpr int photons = 200'000;
  const Material material{1, 0, 0, 0.6};
  const Microfacets facets(material.roughness);
  const Vector3 in = incoming(degrees(60)), from = -in;
  // Walter's sampling with the roulette that belongs to visible normals.
  const auto twin = [&](RandomStream& stream) -> Scattered {
    const double place = stream.uniform(), first = stream.uniform(), second = stream.uniform();
    const double tangent = material.roughness * std::sqrt(first / (1 - first));
    const double cosine = 1 / std::hypot(1.0, tangent);
    const Vector3 out = reflect(in, polar(tangent * cosine, cosine, 2 * pi * second));
    if (!(out.z() > 0) || !(place < facets.unshadowed(from, out))) return {Interaction::absorbed, in};
    return {Interaction::reflected, out};
  };
  CHECK(test::rejected(chi_square_joined(counted(photons, 77, twin), expected(material, in, photons))));
}

TEST_CASE("what survives on a rough mirror is its albedo by quadrature", "[long]") {
  constexpr int photons = 40'000;
  double worst_z = 0;
  std::vector<double> values, expectations, noise;
  for (const double alpha : {1e-4, 0.01, 0.1, 0.3, 0.6, 1.0})
    for (const double incidence : {0.0, 30.0, 60.0, 80.0, 89.0, 89.99}) {
      const Material material{1, 0, 0, alpha};
      const double albedo = glossy_albedo(material, degrees(incidence));
      CAPTURE(alpha, incidence, albedo);
      CHECK(albedo <= 1 + 1e-6);
      CHECK(albedo > 0.2);
      int survived = 0;
      for (int i = 0; i < photons; ++i) {
        RandomStream stream(static_cast<std::uint64_t>(1e6 * alpha + 10 * incidence), Purpose::test,
                            static_cast<std::uint64_t>(i));
        survived += scatter(material, Roulette::all, incoming(degrees(incidence)), up, stream).interaction ==
                    Interaction::reflected;
      }
      const double deviation = std::sqrt(std::max(albedo * (1 - albedo), 0.25 / photons) / photons);
      values.push_back(static_cast<double>(survived) / photons);
      expectations.push_back(albedo);
      noise.push_back(deviation);
      worst_z = std::max(worst_z, std::abs(values.back() - albedo) / deviation);
    }
  // alpha 1 spreads the facets evenly; head-on their shares are integrals of c / (1 + c).
  CHECK(glossy_albedo({1, 0, 0, 1}, 0) == Approx(1 - std::log(2.0)).epsilon(1e-7));
  CAPTURE(worst_z);
  CHECK(test::plausible(test::z_test_p(values, expectations, noise)));
  // wrong twin: nothing is lost
  CHECK(test::rejected(test::z_test_p(values, std::vector<double>(values.size(), 1.0), noise)));
}

TEST_CASE("directions mirrored at visible normals have their density") {
  // Whatever lies above the surface; the density's own integral there is the share that does.
  constexpr int photons = 200'000;
  const Vector3 in = incoming(degrees(50)), from = -in;
  const Microfacets facets(0.5);
  std::vector<double> want(1 + bands * columns, 0);
  double sum = 0;
  for (std::size_t band = 0; band < bands; ++band)
    for (std::size_t column = 0; column < columns; ++column) {
      const double low = static_cast<double>(band) / bands, step = 2 * pi / columns;
      double& due = want[1 + columns * band + column];
      due = photons * test::integral(low, low + 1.0 / bands, 4, [&](double cosine) {
              const double first = (static_cast<double>(column) - 0.5 * columns) * step;
              return test::integral(first, first + step, 4, [&](double azimuth) {
                return facets.density(from, polar(std::sqrt(1 - cosine * cosine), cosine, azimuth));
              });
            });
      sum += due;
    }
  want[0] = photons - sum;
  CHECK(test::plausible(
      chi_square_joined(counted(photons, 51,
                                [&](RandomStream& stream) -> Scattered {
                                  const double first = stream.uniform(), second = stream.uniform();
                                  const Vector3 out = reflect(in, facets.visible_normal(from, first, second));
                                  return {out.z() > 0 ? Interaction::reflected : Interaction::absorbed, out};
                                }),
                        want)));
}

TEST_CASE("a matt surface in an even light is as bright as the light") {
  for (const double cosine : {1.0, 0.5, 1e-3}) {
    const Vector3 out = polar(std::sqrt(1 - cosine * cosine), cosine, 1);
    const double sent = 2 * pi * test::integral(0, 1, 1, [&](double c) {
                          return bsdf(Material::matt(1), polar(std::sqrt(1 - c * c), -c, 0.3), out, up) * c;
                        });
    CHECK(sent == Approx(1).epsilon(1e-12));
  }
}

TEST_CASE("the reflectance distribution is the same the other way round") {
  RandomStream stream(9, Purpose::test, 1);
  const auto direction = [&] {
    const double cosine = 1 - stream.uniform(), azimuth = 2 * pi * stream.uniform();
    return polar(std::sqrt(1 - cosine * cosine), cosine, azimuth);
  };
  Material metal = Material::metal(1.1, 6.6);
  metal.roughness = 0.05;
  for (const Material& material : {Material{0.6, 0, 0.3, 0.3}, Material{1, 0, 0, 1e-3}, metal})
    for (int i = 0; i < 1000; ++i) {
      const Vector3 a = direction(), b = direction();
      const double there = bsdf(material, -a, b, up), back = bsdf(material, -b, a, up);
      CHECK(there >= 0);
      CHECK(there == Approx(back).epsilon(1e-10).margin(1e-300));
    }
  CHECK(bsdf(Material::matt(1), -up, -up, up) == 0);
}

TEST_CASE("a mirror becomes smooth as its roughness goes") {
  const Vector3 in = incoming(degrees(70)), mirrored = reflect(in, up);
  for (const double alpha : {1e-6, 1e-4, 1e-2}) {
    double mean = 0;
    constexpr int photons = 2000;
    int reflected = 0;
    for (int i = 0; i < photons; ++i) {
      RandomStream stream(12, Purpose::test, static_cast<std::uint64_t>(i));
      const Scattered after = scatter({1, 0, 0, alpha}, Roulette::all, in, up, stream);
      if (after.interaction != Interaction::reflected) continue;
      ++reflected;
      mean += std::min(1.0, (after.direction - mirrored).norm()) / photons;
    }
    CHECK(reflected > (alpha < 1e-3 ? photons - 3 : photons * 0.98));
    CHECK(mean < 20 * alpha);
    CHECK(mean > alpha / 20);
  }
}

TEST_CASE("no roughness and no incidence makes a direction that is none") {
  for (const double alpha : {1e-6, 1e-4, 0.1, 1.0})
    for (const double incidence : {0.0, 1e-9, 45.0, 89.99, 90 - 1e-9, 90.0}) {
      const Vector3 in = incoming(degrees(incidence));
      for (int i = 0; i < 500; ++i) {
        RandomStream stream(13, Purpose::test, static_cast<std::uint64_t>(i));
        const Scattered after = scatter({1, 0, 0, alpha}, Roulette::all, in, up, stream);
        CHECK(after.direction.allFinite());
        CHECK(std::abs(after.direction.norm() - 1) < 1e-14);
        if (after.interaction == Interaction::reflected) {
          CHECK(after.direction.z() > 0);
          CHECK(std::isfinite(bsdf({1, 0, 0, alpha}, in, after.direction, up)));
        }
      }
    }
}
