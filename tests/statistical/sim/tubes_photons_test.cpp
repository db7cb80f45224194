#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "base/units.h"
#include "cad/engines.h"
#include "sim/simulation.h"
#include "sim/tubes.h"
#include "support/statistics.h"

/// The rung "tubes" against the photon rung on mirrors without a closed form: folds, light that crosses the
/// axis, several bounces. Both have the same kernel, so that no bias stands between them.

using namespace catoptric;
using namespace catoptric::sim;

namespace {

const PointSource source({0, 0, 50}, pi / 100);
const auto field = NearField::disc({0, 0, 0}, {0, 0, 1}, 100);
constexpr double kernel_mm = 6;

Profile start(double w1, double x2_mm) {
  return Profile::bezier({{0, 100, 1}, {50, 100, w1}, {x2_mm, 50, 1}});
}

/// Samples that lie along one radius: neighbours share photons, those two kernels apart do not.
std::vector<FieldSample> along_radius(int count) {
  std::vector<FieldSample> samples;
  for (int i = 0; i < count; ++i)
    samples.push_back(
        {{100.0 * (i + 0.5) / count * std::cos(i), 100.0 * (i + 0.5) / count * std::sin(i), 0}, {0, 0, 1}});
  return samples;
}

struct Comparison {
  double worst_z;  ///< largest difference in units of the replicates' standard error
};

/// Replicated Sobol photons give mean and standard error without an assumption on their evenness.
Comparison compare(const Profile& tubes_profile, const Profile& photons_profile, const Material& material) {
  const auto mirror = cad::make_meridian_reflector(photons_profile);
  const auto samples = along_radius(24);
  TubesOptions options;
  options.kernel_radius_mm = kernel_mm;
  options.tolerance_w_per_mm2 = from_w_per_m2(1e-5);  // far below the photons' noise
  options.most_rays = 20'000;
  const auto lit = cad::make_meridian_reflector(tubes_profile);
  const TubesField tubes = tubes_field(Scene{source, *lit, material, field}, samples, options);
  // A cavity's light may need more rays than allowed; the bound then says so.
  CHECK((tubes.error_w_per_mm2 <= options.tolerance_w_per_mm2 || tubes.rays + 14 > options.most_rays));
  constexpr int streams = 8;
  std::vector<std::vector<double>> replicates;
  for (std::uint64_t stream = 0; stream < streams; ++stream)
    replicates.push_back(simulate(Scene{source, *mirror, material, field}, samples,
                                  {1 << 16, Sampler::sobol, 3, stream, 1000},
                                  {Kernel::silverman, {}, kernel_mm})
                             .reflected);
  Comparison result{0};
  for (std::size_t i = 0; i < samples.size(); ++i) {
    double mean = 0, square = 0;
    for (const auto& one : replicates) mean += one[i] / streams;
    for (const auto& one : replicates) square += (one[i] - mean) * (one[i] - mean) / (streams - 1.0);
    // Where the rays allowed did not suffice, the tubes say how far off they may be.
    const bool met = tubes.error_w_per_mm2 <= options.tolerance_w_per_mm2;
    const double off =
        std::max(0.0, std::abs(mean - tubes.irradiance[i]) - (met ? 0.0 : tubes.error_w_per_mm2));
    INFO("r " << samples[i].point_mm.head<2>().norm() << " tubes " << to_w_per_m2(tubes.irradiance[i])
              << " photons " << to_w_per_m2(mean) << " +- " << to_w_per_m2(std::sqrt(square / streams)));
    CAPTURE(tubes.rays);
    // A floor for places that hold a handful of photons or none: one photon in all replicates.
    const double one_photon = source.power_w() / (1 << 16) / streams * 3 / (pi * kernel_mm * kernel_mm);
    result.worst_z = std::max(result.worst_z, off / (std::sqrt(square / streams) + one_photon));
  }
  return result;
}

/// Student's t with 7 degrees of freedom, some 24 samples and 8 mirrors: below 1e-6 for all of them together.
constexpr double most_z = 17;

}  // namespace

TEST_CASE("tubes agree with photons on the paper's starts", "[tubes]") {
  for (const Profile& profile : {start(1.6, 90), start(1.8, 70), start(std::sqrt(0.5), 50), start(0.3, 30)}) {
    const Comparison got = compare(profile, profile, {0.9, 0});
    CHECK(got.worst_z < most_z);
  }
}

TEST_CASE("tubes agree with photons on folds, cavities and half-silvered mirrors", "[tubes][long]") {
  // A ripple whose light folds over, with kinks at two knots; a deep pot with many bounces; an open shell.
  const Profile ripple(3, {0, 0, 0, 0, 0.3, 0.5, 0.5, 0.5, 0.8, 1, 1, 1, 1},
                       {{0, 95, 1},
                        {15, 95, 1},
                        {30, 70, 2},
                        {45, 95, 1},
                        {60, 85, 1},
                        {70, 60, 1},
                        {80, 75, 1},
                        {95, 60, 1},
                        {100, 30, 1}});
  const Profile pot = Profile::bezier({{0, 110, 1}, {70, 110, 1}, {70, 60, 3}, {25, 20, 1}});
  const Profile ring = Profile::bezier({{30, 90, 1}, {70, 80, 1}, {60, 10, 1}});
  for (const Profile& profile : {ripple, pot, ring})
    for (const Material& material :
         {Material{0.9, 0}, Material{0.5, 0.4}, Material::with_table({0, 0.5, 1.2}, {0.9, 0.4, 0.8})}) {
      const Comparison got = compare(profile, profile, material);
      CHECK(got.worst_z < most_z);
    }
}

TEST_CASE("tubes agree with photons where the reflectance goes with the angle", "[tubes]") {
  for (const Profile& profile : {start(1.6, 90), start(0.3, 30)})
    for (const Material& material : {Material::metal(1.5, 0.5), Material::with_table({0, 0.7}, {0.2, 1})})
      CHECK(compare(profile, profile, material).worst_z < most_z);
}

TEST_CASE("the comparison sees a mirror that is not the same", "[tubes]") {
  CHECK(compare(start(1.6, 90), start(1.59, 90), {}).worst_z > most_z);
}
