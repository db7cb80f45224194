#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "base/units.h"
#include "sim/simulation.h"
#include "support/analytic_reflectors.h"
#include "support/emission_points.h"
#include "support/smoothed_field.h"
#include "support/statistics.h"

using namespace catoptric;
using namespace catoptric::sim;

namespace {

constexpr double power = pi / 100;
const auto mirror = test::paraboloid();
const PointSource source({0, 0, 50}, power);
const auto field = NearField::disc({0, 0, 0}, {0, 0, 1}, 50);

double eq12(const Vector2& at) {
  const double t = 1 + at.squaredNorm() / 10'000;
  return power / (4 * pi * 2500 * t * t);
}

PhotonOptions photons(std::uint64_t count, std::uint64_t stream = 0, Sampler sampler = Sampler::random) {
  return {count, sampler, 1, stream, 1000};
}

/// Root mean square of reflected field minus its expectation under the kernel: noise alone, no bias; W/m^2.
double noise_rmse(Kernel kernel, double radius, const PhotonOptions& options) {
  const auto samples = field.samples(400);
  const auto got = simulate({source, mirror, {}, field}, samples, options, {kernel, {}, radius});
  double sum = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double expected = test::smoothed(kernel, radius, field.to_plane(samples[i].point_mm), eq12);
    sum += std::pow(to_w_per_m2(got.reflected[i] - expected), 2);
  }
  return std::sqrt(sum / static_cast<double>(samples.size()));
}

double mean_noise_rmse(std::uint64_t count, Sampler sampler, int streams) {
  double sum = 0;
  for (int stream = 0; stream < streams; ++stream)
    sum += std::pow(
        noise_rmse(Kernel::silverman, 5, photons(count, static_cast<std::uint64_t>(stream), sampler)), 2);
  return std::sqrt(sum / streams);
}

}  // namespace

TEST_CASE("RMSE falls as theory says: random photons by N^-1/2, Sobol points faster", "[long]") {
  constexpr int streams = 8;
  const double coarse = mean_noise_rmse(1'000, Sampler::random, streams);
  const double fine = mean_noise_rmse(100'000, Sampler::random, streams);
  // Some 100 independent kernel areas times 8 streams: each RMSE is good to 1/sqrt(2 * 800) = 2.5 %, the
  // slope over a factor of 100 to 0.008; five of these.
  CHECK(std::log(fine / coarse) / std::log(100.0) == Approx(-0.5).margin(0.04));
  // predicted: mean over the field of sqrt(9/5 E w / (pi r^2)), E being 1 to 0.64 W/m^2 there (mean 0.8)
  const double predicted = std::sqrt(1.8 * 0.8 * to_w_per_m2(power / 2 / 100'000) / (pi * 25));
  CHECK(fine == Approx(predicted).epsilon(5 * 0.025));
  const double sobol_coarse = mean_noise_rmse(1'000, Sampler::sobol, streams);
  const double sobol_fine = mean_noise_rmse(100'000, Sampler::sobol, streams);
  CHECK(sobol_fine < 0.2 * fine);
  CHECK(std::log(sobol_fine / sobol_coarse) / std::log(100.0) < -0.65);
}

TEST_CASE("the reported noise is the spread over streams, for every kernel", "[long]") {
  const std::vector<FieldSample> one{{{20, 10, 0}, {0, 0, 1}}};
  const std::array kernels{Kernel::silverman, Kernel::epanechnikov, Kernel::cone, Kernel::gaussian,
                           Kernel::constant};
  constexpr int streams = 300;
  std::array<std::vector<double>, 5> values;
  std::array<double, 5> reported{};
  for (std::uint64_t stream = 0; stream < streams; ++stream) {
    const auto traced = trace_photons({source, mirror, {}, field}, photons(20'000, stream), 8);
    const PhotonMap map(field, traced);
    for (std::size_t k = 0; k < kernels.size(); ++k) {
      const auto got = map.estimate(one, {kernels[k], {}, 8.0});
      values[k].push_back(got.irradiance[0]);
      reported[k] += got.noise[0] * got.noise[0] / streams;
    }
  }
  for (std::size_t k = 0; k < kernels.size(); ++k) {
    double mean = 0, spread = 0;
    for (double value : values[k]) mean += value / streams;
    for (double value : values[k]) spread += (value - mean) * (value - mean);
    const double ratio = spread / reported[k];  // chi-square of streams - 1
    const double tail = test::chi_square_tail(ratio, streams - 1);
    CAPTURE(name(kernels[k]), ratio);
    CHECK(test::plausible(2 * std::min(tail, 1 - tail)));
    const double wrong = test::chi_square_tail(ratio / 2.25, streams - 1);  // wrong twin: noise 1.5 times
    CHECK(test::rejected(1 - wrong));
    // unbiased: the mean over streams is the smoothed field
    const double expected = test::smoothed(kernels[k], 8.0, {20, 10}, eq12);
    CHECK(test::plausible(test::normal_p((mean - expected) / std::sqrt(reported[k] / streams))));
  }
}

TEST_CASE("the nearest N give the field up to the edge of the patch, within bias and noise") {
  const auto samples = field.samples(200);
  const auto got =
      simulate({source, mirror, {}, field}, samples, photons(1'000'000), {Kernel::silverman, 2000, {}});
  double mean = 0, outer = 0, outer_count = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Vector2 at = field.to_plane(samples[i].point_mm);
    const double ratio = got.reflected[i] / eq12(at);
    mean += ratio / 200;
    if (at.norm() > 45) outer += ratio, ++outer_count;
  }
  // Two thousand photons under a Silverman kernel: noise 3 % a point; some 60 independent points in all and
  // 12 on the rim. Bias: r is 6 to 8 mm, E'' r^2 / 8 below 0.3 %; a missing edge would read 50 %.
  CHECK(mean == Approx(1).margin(5 * 0.03 / std::sqrt(60) + 0.003));
  CHECK(outer / outer_count == Approx(1).margin(5 * 0.03 / std::sqrt(12) + 0.003));
}

TEST_CASE("photons are recorded as far out as the estimates at the edge reach") {
  const auto samples = field.samples(300);
  for (const EstimateOptions& options :
       {EstimateOptions{Kernel::constant, {}, 20.0}, EstimateOptions{Kernel::silverman, 500, {}}}) {
    const auto got = simulate({source, mirror, {}, field}, samples, photons(20'000), options);
    const auto all = trace_photons({source, mirror, {}, field}, photons(20'000), 1e6);
    const auto want = PhotonMap(field, all).estimate(samples, options);
    for (std::size_t i = 0; i < samples.size(); ++i)
      CHECK(got.reflected[i] == Approx(want.irradiance[i]).epsilon(1e-12));
  }
}

TEST_CASE("an even field on a real patch reads even up to its edge", "[long]") {
  for (const auto& patch :
       {NearField::disc({0, 0, 0}, {0, 0, 1}, 50, Material::matt(0)),
        NearField::rectangle({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, 80, 50, Material::matt(0))}) {
    TracedPhotons traced;
    std::vector<Crossing> crossings;
    traced.area = RecordedArea::about(patch, 0);
    const auto numbers = test::emission_points(Sampler::sobol, 9, 0, 400'000);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const auto& number = numbers[i];
      const Vector2 at(patch.half_width_mm() * (2 * number[0] - 1),
                       patch.half_height_mm() * (2 * number[1] - 1));
      if (patch.contains(at)) crossings.push_back({at.x(), at.y(), 2 * i + 1});
    }
    traced.chunks.push_back(store(crossings, traced.area));
    traced.photon_power_w = patch.area_mm2() / static_cast<double>(crossings.size());  // 1 W/mm^2
    auto samples = patch.samples(300);
    const std::size_t on_edge = samples.size();
    const double x = patch.half_width_mm() * (1 - 1e-9);
    samples.push_back({patch.to_space({x, 0}), patch.normal()});
    if (patch.shape() == NearField::Shape::rectangle)
      samples.push_back({patch.to_space({x, -patch.half_height_mm() * (1 - 1e-9)}), patch.normal()});
    for (const EstimateOptions& options :
         {EstimateOptions{Kernel::silverman, {}, 7.0}, EstimateOptions{Kernel::constant, {}, 7.0},
          EstimateOptions{Kernel::silverman, 5000, {}}, EstimateOptions{Kernel::cone, {}, 200.0}}) {
      const auto flat = PhotonMap(patch, traced).estimate(samples, options);
      // random points would spread by 1.4 %; five of that bound the Sobol points' error from above
      for (double value : flat.irradiance) CHECK(value == Approx(1).margin(0.02));
    }
    // wrong twin: no correction, as if photons beyond the edge had been recorded and were not there
    TracedPhotons uncorrected = traced;
    uncorrected.area.half_width_mm *= 2;
    uncorrected.area.half_height_mm *= 2;
    const auto dark = PhotonMap(patch, uncorrected).estimate(samples, {Kernel::silverman, {}, 7.0});
    CHECK(dark.irradiance[on_edge] == Approx(0.5).margin(0.05));
  }
}

TEST_CASE("a real patch reads what the invisible register reads, edge included") {
  // The end of the field at r = 50 has a slope; the corrected estimate there is wrong by slope times the
  // kernel's centre of mass, some 0.3 r: E'/E = 4 r / (4 a^2 + r^2) = 1.6 % a mm.
  const auto real = NearField::disc({0, 0, 0}, {0, 0, 1}, 50, Material::matt(0));
  const auto samples = field.samples(100);
  const EstimateOptions options{Kernel::silverman, {}, 4.0};
  const auto a = simulate({source, mirror, {}, field}, samples, photons(500'000), options);
  const auto b = simulate({source, mirror, {}, real}, samples, photons(500'000), options);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double r = field.to_plane(samples[i].point_mm).norm();
    const double noise = std::hypot(a.noise[i], b.noise[i]);
    if (r < 46)
      CHECK(b.reflected[i] == Approx(a.reflected[i]).epsilon(1e-12));
    else
      CHECK(std::abs(b.reflected[i] - a.reflected[i]) < 5.5 * noise + 0.016 * 0.3 * 4 * a.reflected[i]);
  }
}

TEST_CASE("a source off the axis: aimed emission gives the field of emission in all directions", "[long]") {
  const PointSource aside({15, 0, 45}, power);
  // the same mirror with a profile that says it may be anywhere: no direction is left out
  const test::QuadricReflector everywhere(20'000, -200, 0, 50, 100, test::sphere(0, 500, -500).profile());
  std::vector<FieldSample> samples;
  for (int x = -4; x <= 4; ++x)
    for (int y = -4; y <= 4; ++y) samples.push_back({{16.0 * x, 16.0 * y, 0}, {0, 0, 1}});
  const auto wide = NearField::disc({0, 0, 0}, {0, 0, 1}, 100);
  const EstimateOptions options{Kernel::silverman, {}, 8.0};
  const auto aimed = simulate({aside, mirror, {}, wide}, samples, photons(1'000'000, 0), options);
  const auto all = simulate({aside, everywhere, {}, wide}, samples, photons(2'000'000, 1), options);
  CHECK(all.energy.emitted_w == Approx(power).epsilon(1e-12));
  CHECK(aimed.energy.emitted_w < 0.6 * power);
  std::vector<double> noise, stronger;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    noise.push_back(std::hypot(aimed.noise[i], all.noise[i]));
    stronger.push_back(1.03 * all.reflected[i]);
  }
  CHECK(test::plausible(test::z_test_p(aimed.reflected, all.reflected, noise)));
  CHECK(test::rejected(test::z_test_p(aimed.reflected, stronger, noise)));
}

TEST_CASE("the nearest N of Sobol photons give a tenth of the error of random ones") {
  // On the paraboloid's field, seen with 400 neighbours (radius 6 to 8 mm): blur (r / 100 mm)^2 / 2 is 0.2 to
  // 0.3 % of the field, the noise of independent photons sqrt(9/5 / 400), 6.7 %.
  const auto samples = field.samples(400);
  const auto relative_rmse = [&](Sampler sampler) {
    const auto got = simulate({source, mirror, {}, field}, samples, photons(100'000, 0, sampler),
                              {Kernel::silverman, 400, {}});
    double sum = 0;
    for (std::size_t i = 0; i < samples.size(); ++i)
      sum += std::pow(got.reflected[i] / eq12(field.to_plane(samples[i].point_mm)) - 1, 2);
    return std::sqrt(sum / 400);
  };
  const double random = relative_rmse(Sampler::random);
  CHECK(random == Approx(0.067).epsilon(0.2));
  CHECK(relative_rmse(Sampler::sobol) < 0.1 * random);
}
