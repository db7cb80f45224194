#include "rayfiles/ray_picker.h"

#include <catch2/catch.hpp>
#include <limits>

#include "base/errors.h"
#include "support/ray_bytes.h"

using namespace catoptric;
using namespace catoptric::rayfiles;
using namespace catoptric::test;

TEST_CASE("a ray is picked by the numbers that are its share of the flux") {
  const RayPicker picker(ListedRays::of_fluxes({0, 1, 0, 2, 1, 0}));
  CHECK(picker.total_flux() == 4);
  const auto is = [&](double u, std::uint64_t ray, double rest) {
    const PickedRay picked = picker.pick(u);
    INFO(u);
    CHECK(picked.ray == ray);
    CHECK(picked.rest == rest);
  };
  is(0, 1, 0);
  is(0.125, 1, 0.5);
  is(0.25, 3, 0);
  is(0.5, 3, 0.5);
  is(0.75, 4, 0);
  is(1 - 0x1p-53, 4, 1 - 0x1p-51);
}

TEST_CASE("shares hold across the blocks of the table") {
  // Flux i % 5 of 320 rays: 640 in all, so that every boundary times 1 / 1024 is exact with another 384
  // behind them.
  std::vector<double> fluxes;
  for (int i = 0; i < 320; ++i) fluxes.push_back(i % 5);
  fluxes.push_back(384);
  const RayPicker picker(ListedRays::of_fluxes(fluxes));
  CHECK(picker.table_bytes() == 7 * sizeof(double));
  double before = 0;
  for (std::size_t i = 0; i < fluxes.size(); ++i) {
    if (fluxes[i] == 0) continue;
    INFO(i);
    const PickedRay first = picker.pick(before / 1024);
    CHECK(first.ray == i);
    CHECK(first.rest == 0);
    before += fluxes[i];
    CHECK(picker.pick(std::nextafter(before / 1024, 0.0)).ray == i);
  }
}

TEST_CASE("rays of one flux need no table") {
  const RayPicker picker(ListedRays::of_fluxes(std::vector<double>(1000, 0.3)));
  CHECK(picker.table_bytes() == 0);
  CHECK(picker.pick(0).ray == 0);
  CHECK(picker.pick(0.5).ray == 500);
  CHECK(picker.pick(0.0625).ray == 62);
  CHECK(picker.pick(0.0625).rest == 0.5);
  CHECK(picker.pick(1 - 0x1p-53).ray == 999);
  CHECK(RayPicker(ListedRays::of_fluxes({7})).pick(0.75).rest == 0.75);
}

TEST_CASE("fluxes that cannot be picked from are refused with the ray") {
  const auto refused = [](const std::vector<double>& fluxes, const char* part) {
    CHECK_THROWS_WITH(RayPicker(ListedRays::of_fluxes(fluxes)), Catch::Contains(part));
  };
  refused({1, 2, -1}, "list, ray 2");
  refused({1, std::numeric_limits<double>::quiet_NaN()}, "list, ray 1");
  refused({std::numeric_limits<double>::infinity()}, "list, ray 0");
  refused({0, 0, 0}, "no ray carries flux");
}

TEST_CASE("fluxes that differ by all that floats can are picked from without a gap") {
  std::vector<double> fluxes(200, 1e-38);
  fluxes[100] = 3e38;
  const RayPicker picker(ListedRays::of_fluxes(fluxes));
  CHECK(picker.pick(0).ray == 0);
  CHECK(picker.pick(0.5).ray == 100);
  const PickedRay last = picker.pick(1 - 0x1p-53);
  CHECK(last.ray >= 100);
  CHECK(last.rest < 1);
}

TEST_CASE("a number beyond the fluxes of its block, for roundings, picks the last ray of it that has any") {
  // Added up one by one the small fluxes are lost, but not in the table's compensated sum: 1 + 62 / 2^54.
  std::vector<double> fluxes(64, 0x1p-54);
  fluxes.front() = 1;
  fluxes.back() = 0;
  const PickedRay last = RayPicker(ListedRays::of_fluxes(fluxes)).pick(1 - 0x1p-53);
  CHECK(last.ray == 62);
  CHECK(last.rest < 1);
}
