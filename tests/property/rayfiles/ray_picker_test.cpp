#include "rayfiles/ray_picker.h"

#include <catch2/catch.hpp>

#include "base/random_stream.h"
#include "support/ray_bytes.h"
#include "support/statistics.h"

using namespace catoptric;
using namespace catoptric::rayfiles;
using namespace catoptric::test;

namespace {

/// Fluxes from 0 to 1, a third of them 0, a few much larger.
std::vector<double> random_fluxes(std::uint64_t seed, std::size_t count) {
  RandomStream random(seed, Purpose::test, 0);
  std::vector<double> fluxes(count);
  for (double& flux : fluxes) {
    const double kind = random.uniform();
    const double size = random.uniform();
    flux = kind < 1.0 / 3 ? 0 : kind < 0.98 ? size : 100 * size;
  }
  fluxes[count / 2] = 1;
  return fluxes;
}

}  // namespace

TEST_CASE("on an even grid of numbers every ray is picked as often as its share says, to one") {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const auto fluxes = random_fluxes(seed, 37 * seed);
    const RayPicker picker(ListedRays::of_fluxes(fluxes));
    constexpr int points = 100'000;
    std::vector<double> counts(fluxes.size());
    for (int i = 0; i < points; ++i) ++counts[picker.pick((i + 0.5) / points).ray];
    double worst = 0;
    for (std::size_t i = 0; i < fluxes.size(); ++i)
      worst = std::max(worst, std::abs(counts[i] - points * fluxes[i] / picker.total_flux()));
    INFO(seed);
    CHECK(worst <= 1 + 1e-6);  // an interval of the grid's length holds one point more or less
  }
}

TEST_CASE("greater numbers pick no earlier ray and no smaller rest") {
  for (const std::size_t count : {1, 2, 63, 64, 65, 1000}) {
    const RayPicker picker(ListedRays::of_fluxes(random_fluxes(count, count)));
    PickedRay last{0, 0};
    bool ordered = true;
    for (double u = 0; u < 1; u = std::nextafter(u + 1.37e-5, 2.0)) {
      for (const double near : {u, std::nextafter(u, 2.0)}) {
        if (near >= 1) continue;
        const PickedRay next = picker.pick(near);
        ordered = ordered && (next.ray > last.ray || (next.ray == last.ray && next.rest >= last.rest)) &&
                  next.rest >= 0 && next.rest < 1;
        last = next;
      }
    }
    INFO(count);
    CHECK(ordered);
  }
}

TEST_CASE("random numbers pick rays by their flux, and what is left of them is even") {
  std::vector<double> fluxes;
  for (int i = 0; i < 150; ++i) fluxes.push_back(1 + i % 7);
  const RayPicker picker(ListedRays::of_fluxes(fluxes));
  constexpr int points = 200'000, bins = 20;
  std::vector<double> counts(fluxes.size()), even(fluxes.size()), expected, rests(bins);
  RandomStream random(5, Purpose::test, 1);
  for (int i = 0; i < points; ++i) {
    const double u = random.uniform();
    const PickedRay picked = picker.pick(u);
    ++counts[picked.ray];
    ++rests[static_cast<std::size_t>(picked.rest * bins)];
    ++even[static_cast<std::size_t>(u * static_cast<double>(fluxes.size()))];  // as if all had the same flux
  }
  for (const double flux : fluxes) expected.push_back(points * flux / picker.total_flux());
  CHECK(plausible(chi_square_p(counts, expected)));
  CHECK(plausible(chi_square_even_p(rests)));
  CHECK(rejected(chi_square_p(even, expected)));  // the wrong twin
}

TEST_CASE("equal fluxes pick alike with and without a table") {
  const std::vector<double> fluxes(256, 1.0);
  auto nearly = fluxes;
  nearly.push_back(0);  // needs a table, and changes no share
  const RayPicker plain(ListedRays::of_fluxes(fluxes)), table(ListedRays::of_fluxes(nearly));
  REQUIRE(plain.table_bytes() == 0);
  REQUIRE(table.table_bytes() > 0);
  RandomStream random(6, Purpose::test, 2);
  for (int i = 0; i < 10'000; ++i) {
    const double u = random.uniform();
    const PickedRay a = plain.pick(u), b = table.pick(u);
    REQUIRE(a.ray == b.ray);
    REQUIRE(a.rest == b.rest);
  }
}
