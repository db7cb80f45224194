#include <catch2/catch.hpp>
#include <cmath>

#include "base/random_stream.h"
#include "base/units.h"
#include "sim/emission.h"
#include "sim/material.h"
#include "sim/near_field.h"
#include "sim/projection_map.h"
#include "sim/scatter.h"
#include "support/analytic_reflectors.h"
#include "support/emission_points.h"
#include "support/statistics.h"

using namespace catoptric;
using namespace catoptric::sim;

namespace {

std::size_t bin(double share, std::size_t bins) {
  return std::min(bins - 1, static_cast<std::size_t>(std::max(0.0, share) * static_cast<double>(bins)));
}

/// Counts of `draw(stream)` (a bin number) over many streams.
template <typename Draw>
std::vector<double> counts_of(std::size_t bins, int draws, const Draw& draw) {
  std::vector<double> counts(bins, 0);
  for (int i = 0; i < draws; ++i) {
    RandomStream stream(5, Purpose::test, static_cast<std::uint64_t>(i));
    counts[draw(stream)] += 1;
  }
  return counts;
}

/// Cell of the sphere, 16 equal bands times 32 equal azimuths.
std::size_t sphere_cell(const Vector3& direction) {
  const double azimuth = std::atan2(direction.y(), direction.x()) / (2 * pi) + 0.5;
  return 32 * bin(0.5 * (direction.z() + 1), 16) + bin(azimuth, 32);
}

}  // namespace

TEST_CASE("emission fills the projection map evenly", "[long]") {
  const auto profile = test::paraboloid().profile();
  constexpr int draws = 400'000, finest = 2000;
  for (const Vector3& source :
       {Vector3(0, 0, 50), Vector3(0, 0, -100), Vector3(30, 0, 60), Vector3(-300, 40, 75)}) {
    const auto map = ProjectionMap::towards(profile, source);
    // expected: the area of the map in each cell, by counting evenly spread directions that belong to it
    std::vector<double> expected(512, 0);
    for (int i = 0; i < finest; ++i)
      for (int j = 0; j < finest; ++j) {
        const double cosine = (2 * i + 1.0) / finest - 1, azimuth = 2 * pi * (j + 0.5) / finest;
        const double sine = std::sqrt(1 - cosine * cosine);
        const Vector3 direction(sine * std::cos(azimuth), sine * std::sin(azimuth), cosine);
        if (map.contains(direction)) expected[sphere_cell(direction)] += 1;
      }
    double inside = 0;
    for (double each : expected) inside += each;
    // the counted area is that of the map, to the cells on its border
    CHECK(4 * pi * inside / finest / finest == Approx(map.solid_angle_sr()).epsilon(0.01));

    const auto run = [&](auto&& direction) {
      auto counts = counts_of(512, draws, [&](RandomStream& stream) {
        const double first = stream.uniform(), second = stream.uniform();
        return sphere_cell(direction(first, second));
      });
      // cells too small for the normal law, and those whose border the counting blurs, are joined
      std::vector<double> got(1, 0), want(1, 0);
      for (std::size_t i = 0; i < 512; ++i) {
        const double share = draws * expected[i] / inside;
        if (expected[i] > 0.999 * finest * finest / 512 * 1.0) {
          got.push_back(counts[i]);
          want.push_back(share);
        } else {
          got[0] += counts[i];
          want[0] += share;
        }
      }
      return test::chi_square_p(got, want);
    };
    CAPTURE(source.transpose());
    CHECK(test::plausible(run([&](double a, double b) { return map.direction(a, b); })));
    // wrong twin: even in the angle instead of its cosine
    CHECK(test::rejected(run([&](double a, double b) { return map.direction(std::sin(0.5 * pi * a), b); })));
  }
}

namespace {

/// Of a photon that keeps its power.
Interaction fate(const Material& material, double number) {
  const Lobe lobe = choose_lobe(material, Roulette::all, 1, [&] { return number; }).lobe;
  return lobe == Lobe::none      ? Interaction::absorbed
         : lobe == Lobe::through ? Interaction::transmitted
                                 : Interaction::reflected;
}

}  // namespace

TEST_CASE("Russian roulette has the frequencies of the material") {
  const Material material{0.7, 0.1};
  const auto counts = counts_of(3, 100'000, [&](RandomStream& stream) {
    return static_cast<std::size_t>(fate(material, stream.uniform()));
  });
  CHECK(test::plausible(test::chi_square_p(counts, {20'000, 70'000, 10'000})));
  CHECK(test::rejected(test::chi_square_p(counts, {21'000, 69'000, 10'000})));
  CHECK(fate({1, 0}, 1 - 0x1p-53) == Interaction::reflected);
  CHECK(fate({0, 0}, 0) == Interaction::absorbed);
  CHECK(fate({0, 1}, 1 - 0x1p-53) == Interaction::transmitted);
}

TEST_CASE("diffuse reflection follows the cosine law into the normal's side") {
  const Vector3 normal = Vector3(1, 2, -3).normalized();
  const Vector3 along = Vector3(2, -1, 0).normalized(), across = normal.cross(along);
  const auto run = [&](const auto& share_of_cosine) {
    return test::chi_square_even_p(counts_of(20 * 16, 200'000, [&](RandomStream& stream) {
      const double first = stream.uniform(), second = stream.uniform();
      const Vector3 direction = diffuse_direction(along, across, normal, first, second);
      const double azimuth = std::atan2(direction.dot(across), direction.dot(along)) / (2 * pi) + 0.5;
      CHECK(direction.dot(normal) > 0);
      return 16 * bin(share_of_cosine(direction.dot(normal)), 20) + bin(azimuth, 16);
    }));
  };
  CHECK(test::plausible(run([](double cosine) { return cosine * cosine; })));
  CHECK(test::rejected(run([](double cosine) { return cosine; })));  // the law of an even hemisphere
}

TEST_CASE("near-field samples are uniform by area") {
  // A spiral and a grid are more even than chance, so only too large a chi-square can be wrong.
  const auto disc = NearField::disc({0, 0, 0}, {0, 0, 1}, 50);
  const auto ring_counts = [&](const auto& share_of_radius) {
    std::vector<double> counts(10 * 8, 0);
    for (const FieldSample& sample : disc.samples(20'000)) {
      const Vector2 at = disc.to_plane(sample.point_mm);
      const double azimuth = std::atan2(at.y(), at.x()) / (2 * pi) + 0.5;
      counts[8 * bin(share_of_radius(at.norm() / 50), 10) + bin(azimuth, 8)] += 1;
    }
    return test::chi_square_even_p(counts);
  };
  CHECK(test::plausible(ring_counts([](double r) { return r * r; })));
  CHECK(test::rejected(ring_counts([](double r) { return r; })));
  const auto rectangle = NearField::rectangle({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, 300, 100);
  std::vector<double> counts(15 * 5, 0);
  for (const FieldSample& sample : rectangle.samples(7500)) {
    const Vector2 at = rectangle.to_plane(sample.point_mm);
    counts[5 * bin(at.x() / 300 + 0.5, 15) + bin(at.y() / 100 + 0.5, 5)] += 1;
  }
  CHECK(test::plausible(test::chi_square_even_p(counts)));
}

TEST_CASE("every scrambled Sobol coordinate is uniform over the keys") {
  // one point of the sequence under many scramblings: what makes replicates unbiased
  struct Ps {
    double alone, pairs;
  };
  const auto judge = [](std::uint64_t photon, std::size_t axis, const auto& key_of) {
    std::vector<double> counts(64, 0), pairs(64, 0);
    for (std::uint64_t stream = 0; stream < 20'000; ++stream) {
      const auto numbers = test::emission_points(Sampler::sobol, key_of(stream), photon, 2);
      const double first = numbers[0][axis], second = numbers[1][axis];
      counts[bin(first, 64)] += 1;
      // digits 7 to 9 of one photon and 4 to 6 of the next: independent, too
      pairs[8 * bin(std::fmod(first * 64, 1.0), 8) + bin(std::fmod(second * 8, 1.0), 8)] += 1;
    }
    return Ps{test::chi_square_even_p(counts), test::chi_square_even_p(pairs)};
  };
  for (std::uint64_t photon : {0u, 1u, 12345u})
    for (std::size_t axis = 0; axis < 4; ++axis) {
      const Ps right = judge(photon, axis, [](std::uint64_t stream) { return photon_key(1, stream); });
      CHECK(test::plausible(right.alone));
      CHECK(test::plausible(right.pairs));
    }
  // wrong twin: half of the streams share a key, so that replicates repeat each other
  const Ps wrong =
      judge(1, 0, [](std::uint64_t stream) { return photon_key(1, stream % 2 == 0 ? 0 : stream); });
  CHECK(test::rejected(wrong.alone));
  CHECK(test::rejected(wrong.pairs));
}

TEST_CASE("photons of one Sobol set lie more evenly than chance in every pair of coordinates") {
  constexpr std::uint64_t photons = 4096;
  for (const Sampler sampler : {Sampler::sobol, Sampler::random}) {
    const auto numbers = test::emission_points(sampler, photon_key(3, 5), 0, photons);
    for (std::size_t a = 0; a < 4; ++a)
      for (std::size_t b = a + 1; b < 4; ++b) {
        std::vector<double> counts(256, 0);
        for (const auto& point : numbers) counts[16 * bin(point[a], 16) + bin(point[b], 16)] += 1;
        double square = 0;
        for (const double count : counts) square += (count - 16) * (count - 16) / 16;
        CAPTURE(static_cast<int>(sampler), a, b, square);
        // random points: chi-square of 255 degrees, 255 +- 23; a two-dimensional net has 0
        if (sampler == Sampler::random)
          CHECK(test::plausible(test::variance_ratio_p(square / 255, 255)));
        else
          CHECK(test::rejected(1 - test::chi_square_tail(square, 255)));  // chance is the wrong twin
      }
  }
}
