#include "sim/photon_map.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>
#include <numeric>

#include "base/random_stream.h"
#include "base/units.h"
#include "sim/edge_correction.h"

using namespace catoptric;
using namespace catoptric::sim;

namespace {

const auto all = {Kernel::silverman, Kernel::epanechnikov, Kernel::cone, Kernel::gaussian, Kernel::constant};

/// Photons of 1 W put by hand on a disc of radius 10 with a recorded margin of 10.
TracedPhotons put(const std::vector<Vector2>& points, bool front = true) {
  TracedPhotons traced;
  traced.area = {NearField::Shape::disc, 20, 20};
  std::vector<Crossing> crossings;
  for (std::size_t i = 0; i < points.size(); ++i)
    crossings.push_back({points[i].x(), points[i].y(), 2 * i + (front ? 1 : 0)});
  const std::span<const Crossing> all_of_them(crossings);
  constexpr std::size_t chunk = 1000;
  for (std::size_t i = 0; i < crossings.size(); i += chunk)
    traced.chunks.push_back(
        store(all_of_them.subspan(i, std::min(chunk, crossings.size() - i)), traced.area));
  traced.photon_power_w = 1;
  return traced;
}

std::vector<Vector2> scattered(std::size_t count) {
  std::vector<Vector2> points;
  for (std::size_t i = 0; i < count; ++i) {
    RandomStream stream(7, Purpose::test, i);
    const double r = 20 * std::sqrt(stream.uniform()), angle = 2 * pi * stream.uniform();
    points.push_back({r * std::cos(angle), r * std::sin(angle)});
  }
  return points;
}

const NearField field = NearField::disc({0, 0, 5}, {0, 0, 1}, 10);
EstimateOptions radius(double r, Kernel kernel = Kernel::silverman) { return {kernel, {}, r}; }
EstimateOptions nearest(std::size_t n, Kernel kernel = Kernel::silverman) { return {kernel, n, {}}; }
const FieldSample center{{0, 0, 5}, {0, 0, 1}};

}  // namespace

TEST_CASE("one photon gives the kernel's value over its disc") {
  const PhotonMap map(field, put({{1, 0}}));
  const auto got = map.estimate(std::vector{center}, radius(2));
  CHECK(got.irradiance[0] == Approx(3 * 0.75 * 0.75 / (pi * 4)));
  CHECK(got.noise[0] == Approx(got.irradiance[0]));  // one photon is as good as its own noise
  CHECK(got.kernel_radius_mm[0] == 2);
  CHECK(got.photons[0] == 1);
  CHECK(map.estimate(std::vector{center}, radius(0.5)).irradiance[0] == 0);
}

TEST_CASE("the bandwidth of the nearest N is the farthest one's distance") {
  const PhotonMap map(field, put({{1, 0}, {0, 2}, {-3, 0}, {0, -4}}));
  const auto got = map.estimate(std::vector{center}, nearest(3));
  CHECK(got.kernel_radius_mm[0] == Approx(3));
  CHECK(got.irradiance[0] == Approx(3 * (std::pow(1 - 1.0 / 9, 2) + std::pow(1 - 4.0 / 9, 2)) / (pi * 9)));
  CHECK(map.estimate(std::vector{center}, nearest(2, Kernel::constant)).irradiance[0] ==
        Approx(2 / (pi * 4)));
}

TEST_CASE("fewer photons than neighbours are all taken, and none is dark") {
  const PhotonMap few(field, put({{1, 0}, {0, 2}}));
  const auto got = few.estimate(std::vector{center}, nearest(std::numeric_limits<std::size_t>::max()));
  CHECK(got.photons[0] == 2);
  CHECK(got.kernel_radius_mm[0] == Approx(2));
  const PhotonMap none(field, put({}));
  for (const auto& options : {radius(2), nearest(5)}) {
    const auto dark = none.estimate(std::vector{center}, options);
    CHECK(dark.irradiance[0] == 0);
    CHECK(dark.noise[0] == 0);
  }
  CHECK(none.estimate({}, radius(2)).irradiance.empty());
}

TEST_CASE("as many neighbours as there are photons are all of them, however many cells these fill") {
  std::vector<Vector2> points;
  for (int i = 0; i < 1000; ++i) points.push_back({8 * std::cos(i) * i / 1000, 8 * std::sin(i) * i / 1000});
  const PhotonMap map(field, put(points));
  for (const std::size_t neighbours : {std::size_t{1000}, std::size_t{5000}}) {
    const auto got = map.estimate(std::vector{center}, nearest(neighbours));
    CHECK(got.photons[0] == 1000);
    CHECK(got.kernel_radius_mm[0] == Approx(8 * 0.999));
  }
}

TEST_CASE("photons that all land in one point give a finite number") {
  const PhotonMap map(field, put(std::vector<Vector2>(100, Vector2(0, 0))));
  const auto got = map.estimate(std::vector{center}, nearest(10, Kernel::constant));
  CHECK(std::isfinite(got.irradiance[0]));
  CHECK(got.irradiance[0] > 1e10);
}

TEST_CASE("photons count only on the side they arrived at") {
  const FieldSample below{{0, 0, 5}, {0, 0, -1}};
  const PhotonMap behind(field, put({{1, 0}}, false));
  CHECK(behind.size({0, 0, 1}) == 0);
  CHECK(behind.size({0, 0, -1}) == 1);
  CHECK(behind.estimate(std::vector{center}, radius(2)).irradiance[0] == 0);
  CHECK(behind.estimate(std::vector{below}, radius(2)).irradiance[0] > 0);
}

TEST_CASE("the map finds what a loop over all photons finds, evenly spread or crowded", "[threads]") {
  auto points = scattered(5000);
  const bool crowded = GENERATE(false, true);
  // Most of them in a thousandth of the area, on a line, or in one point, the rest where they were.
  if (crowded)
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (i % 5 < 3) points[i] = Vector2(3, -4) + 0.03 * points[i];
      if (i % 5 == 3) points[i].y() = 1;
      if (i % 25 == 0) points[i] = {-6, 2};
    }
  const PhotonMap map(field, put(points));
  const auto samples = field.samples(50);
  for (Kernel kernel : all)
    for (const auto& options : {radius(1.5, kernel), radius(15, kernel), nearest(1, kernel),
                                nearest(37, kernel), nearest(4000, kernel)}) {
      const auto got = map.estimate(samples, options);
      for (std::size_t i = 0; i < samples.size(); ++i) {
        const Vector2 at = field.to_plane(samples[i].point_mm);
        std::vector<double> distances;
        for (const Vector2& point : points) distances.push_back((point - at).norm());
        std::sort(distances.begin(), distances.end());
        const double r =
            options.kernel_radius_mm ? *options.kernel_radius_mm : distances[*options.neighbours - 1];
        // Photons in one point are as near as each other: exactly N of them count.
        if (options.neighbours) distances.resize(*options.neighbours);
        double sum = 0, square = 0;
        for (double d : distances) {
          const double weight = kernel_value(kernel, d <= r ? std::min(1.0, d / r) : 2);
          sum += weight;
          square += weight * weight;
        }
        const double scale =
            1 / (pi * r * r * kernel_mass_inside(kernel, r, {NearField::Shape::disc, 20, 20}, at));
        CHECK(got.kernel_radius_mm[i] == Approx(r).epsilon(1e-14));
        // sums of thousands of terms in another order; t near 1 loses digits in 1 - t
        CHECK(got.irradiance[i] == Approx(sum * scale).epsilon(1e-11).margin(1e-13 * scale));
        CHECK(got.noise[i] == Approx(std::sqrt(square) * scale).epsilon(1e-11).margin(1e-13 * scale));
      }
    }
}

TEST_CASE("a bandwidth must be set, once, and be positive") {
  CHECK_THROWS_AS(check(EstimateOptions{}), InputError);
  CHECK_THROWS_AS(check(EstimateOptions{Kernel::cone, 5, 2.0}), InputError);
  CHECK_THROWS_AS(check(nearest(0)), InputError);
  for (double bad :
       {0.0, -1.0, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()})
    CHECK_THROWS_AS(check(radius(bad)), InputError);
  CHECK_NOTHROW(check(radius(1e-9)));
}

TEST_CASE("a ladder of radii shows what each radius by itself shows", "[threads]") {
  auto points = scattered(3000);
  points.push_back({0, 0});  // on a sample: its squared distance has no binary exponent
  points.push_back({4, 0});  // on the border of the widest kernel about that sample: no weight, nor beyond it
  const PhotonMap map(field, put(points));
  auto samples = field.samples(50);
  samples.push_back(center);
  // The wider one holds more photons than are weighed at a time.
  const double widest = GENERATE(4.0, 20.0);
  const std::size_t levels = 18;  // down to a kernel that holds the photon on the sample alone
  const auto fields = map.ladder(samples, widest, levels);
  REQUIRE(fields.size() == levels);
  for (std::size_t level = 0; level < levels; ++level) {
    const double narrowed = widest * std::pow(0.5, 0.5 * static_cast<double>(level));
    const auto alone = map.estimate(samples, radius(narrowed)).irradiance;
    for (std::size_t i = 0; i < samples.size(); ++i)
      CHECK(fields[level][i] == Approx(alone[i]).epsilon(1e-12).margin(1e-14));
    CHECK(fields[level].back() > 0);
  }
}

TEST_CASE("a ladder looks at its samples' side of the plane") {
  const PhotonMap map(field, put(scattered(100), false));
  CHECK(map.ladder(std::vector{center}, 10, 2)[0][0] == 0);
  CHECK(map.ladder(std::vector{FieldSample{{0, 0, 5}, {0, 0, -1}}}, 10, 2)[0][0] > 0);
}
