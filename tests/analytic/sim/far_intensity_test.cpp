#include <catch2/catch.hpp>
#include <cmath>

#include "base/units.h"
#include "sim/disc_source.h"
#include "sim/far_intensity.h"
#include "sim/frame.h"
#include "support/analytic_reflectors.h"
#include "support/flat_mirror.h"
#include "support/statistics.h"

/// Intensity of a luminaire from afar against closed forms.

using namespace catoptric;
using namespace catoptric::sim;

namespace {

constexpr double power = 3, degree = pi / 180;
const Eigen::Matrix3d upright = Eigen::Matrix3d::Identity();

FarIntensity light(const Source& source, const Reflector& mirror, const IntensityGrid& grid,
                   std::uint64_t photons, double reflectance = 1, std::uint64_t stream = 1) {
  const NearField field = NearField::disc({0, 0, -1000}, {0, 0, 1}, 10);
  return far_intensity({source, mirror, {reflectance, 0}, field}, grid, {photons, Sampler::sobol, 3, stream});
}

IntensityTable table(const IntensityGrid& grid, const FarIntensity& found) {
  return {LightQuantity::radiant, grid.gamma_deg, grid.c_deg, found.w_per_sr};
}

}  // namespace

TEST_CASE("a bare source has its own intensity from afar, about any axis", "[long]") {
  const test::FlatMirror far_away(1e5, 1);  // which light hardly meets
  const Vector3 axis = Vector3(0.4, -0.3, 0.8).normalized();
  const PointSource even({1, 2, 3}, power), beam({1, 2, 3}, power, 4, axis);
  const LambertianDisc disc({0, 0, 5}, 2, axis, power);
  for (const Source* source : {static_cast<const Source*>(&even), static_cast<const Source*>(&beam),
                               static_cast<const Source*>(&disc)}) {
    CAPTURE(source->words());
    const IntensityGrid grid = even_grid(5, 10, frame_along({0, 0.6, 0.8}, {1, 0, 0}));
    const FarIntensity found = light(*source, far_away, grid, 1 << 21);
    const double greatest = power * 5 / (2 * pi);
    for (std::size_t plane = 0; plane < grid.c_deg.size(); ++plane)
      for (std::size_t i = 0; i < grid.gamma_deg.size(); ++i) {
        const double gamma = grid.gamma_deg[i] * degree, c = grid.c_deg[plane] * degree;
        const Vector3 way = grid.frame * Vector3(std::sin(gamma) * std::cos(c), std::sin(gamma) * std::sin(c),
                                                 std::cos(gamma));
        CHECK(found.w_per_sr[plane * grid.gamma_deg.size() + i] ==
              Approx(source->intensity_w_per_sr(way)).margin(0.012 * greatest));
      }
    CHECK(table(grid, found).flux() == Approx(power).epsilon(1e-6));
    CHECK(found.departed_w == Approx(power).epsilon(1e-12));
  }
}

TEST_CASE("a flat mirror adds its image's intensity, times its reflectance", "[threads]") {
  const test::FlatMirror mirror(10, 1e7);
  const PointSource source({0, 0, 0}, power);
  const IntensityGrid grid = even_grid(3, 0, frame_along({0, 0, -1}, {1, 0, 0}));
  const FarIntensity found = light(source, mirror, grid, 1 << 20, 0.6);
  for (std::size_t i = 1; i < grid.gamma_deg.size(); ++i) {
    if (std::abs(grid.gamma_deg[i] - 90) < 4) continue;  // its edge, a step
    CHECK(found.w_per_sr[i] ==
          Approx((grid.gamma_deg[i] < 90 ? 1.6 : 0.0) * power / (4 * pi)).epsilon(0.01).margin(1e-12));
  }
  CHECK(found.departed_w == Approx(0.8 * power).epsilon(0.002));
  CHECK(table(grid, found).flux() == Approx(found.departed_w).epsilon(1e-6));
}

TEST_CASE("a bundle of parallel rays is in one direction, and its flux is all there") {
  // A paraboloid whose focus is the source: r^2 = 4 a (focus + a - z), from its apex at 20 down to the focus.
  const double a = 10;
  const test::QuadricReflector bowl(4 * a * (10 + a), -4 * a, 0, 10, 20,
                                    Profile::bezier({{0, 20, 1}, {10, 20, 1}, {20, 10, 1}}));
  const PointSource source({0, 0, 10}, power);
  for (const double step : {2.0, 0.5}) {
    const IntensityGrid grid = even_grid(step, 0, frame_along({0, 0, -1}, {1, 0, 0}));
    const FarIntensity found = light(source, bowl, grid, 1 << 16);
    CHECK(table(grid, found).flux() == Approx(power).epsilon(1e-6));
    // Half of the light goes down the axis, into the node there alone; the other half was never met.
    const double hat = 2 * pi * (1 - std::sin(step * degree) / (step * degree));
    CHECK(found.w_per_sr[0] == Approx(0.5 * power / hat).epsilon(0.01));
    CHECK(found.w_per_sr[static_cast<std::size_t>(20 / step)] == Approx(power / (4 * pi)).epsilon(0.05));
  }
}

TEST_CASE("wide steps show their bias, and the bias says how much", "[long]") {
  const test::FlatMirror far_away(1e5, 1);
  const PointSource beam({0, 0, 0}, power, 30);
  const IntensityGrid grid = even_grid(4, 0, upright);
  const FarIntensity found = light(beam, far_away, grid, 1 << 22);
  const std::vector<double> bias = step_bias(grid, found.w_per_sr);
  double raw = 0, mended = 0;
  for (std::size_t i = 1; i < 12; ++i) {
    const double truth = beam.intensity_w_per_sr(
        {std::sin(grid.gamma_deg[i] * degree), 0, std::cos(grid.gamma_deg[i] * degree)});
    raw += std::pow(found.w_per_sr[i] - truth, 2);
    mended += std::pow(found.w_per_sr[i] - bias[i] - truth, 2);
  }
  CHECK(raw > 25 * mended);
}

TEST_CASE("the intensity is the same bits whatever the order of the sums") {
  const test::FlatMirror mirror(10, 50);
  const PointSource source({0, 0, 0}, power);
  const IntensityGrid grid = even_grid(3, 30, upright);
  const auto first = light(source, mirror, grid, 100'000), again = light(source, mirror, grid, 100'000);
  CHECK(first.w_per_sr == again.w_per_sr);
  CHECK(first.w_per_sr != light(source, mirror, grid, 100'000, 1, 2).w_per_sr);
}

TEST_CASE("steps that do not fit are made smaller") {
  const IntensityGrid grid = even_grid(7, 100, upright);
  CHECK(grid.gamma_deg.size() == 27);
  CHECK(grid.gamma_deg.back() == 180);
  CHECK(grid.c_deg == std::vector<double>{0, 90, 180, 270});
  CHECK(even_grid(2.5, 0, upright).gamma_deg.size() == 73);
}
