#include <catch2/catch.hpp>
#include <cmath>

#include "design/scene.h"
#include "design/stage.h"
#include "sim/rings.h"
#include "sim/simulation.h"
#include "support/statistics.h"

using namespace catoptric;
using namespace catoptric::design;

namespace {

constexpr double kernel_mm = 10;
constexpr std::uint64_t sets = 40;

/// So far apart that they share no photon of one set.
const std::vector<double> radii_mm{0, 30, 60, 90, 115};

std::vector<sim::FieldSample> samples() {
  std::vector<sim::FieldSample> all;
  for (const double r : radii_mm) all.push_back({{r * std::cos(r), r * std::sin(r), 0}, {0, 0, 1}});
  return all;
}

struct Field {
  std::vector<double> mean, variance;
};

/// Mean over the sets and its variance.
template <typename Light>
Field over_sets(const Light& light) {
  Field field{std::vector<double>(radii_mm.size(), 0), std::vector<double>(radii_mm.size(), 0)};
  std::vector<std::vector<double>> all;
  for (std::uint64_t stream = 0; stream < sets; ++stream)
    all.push_back(light(sim::PhotonOptions{10'000, sim::Sampler::random, 3, stream, 100}));
  for (std::size_t i = 0; i < radii_mm.size(); ++i) {
    for (const auto& one : all) field.mean[i] += one[i] / sets;
    for (const auto& one : all)
      field.variance[i] += std::pow(one[i] - field.mean[i], 2) / (sets * (sets - 1.0));
  }
  return field;
}

double agreement(const Field& one, const Field& other) {
  std::vector<double> noise;
  for (std::size_t i = 0; i < one.mean.size(); ++i)
    noise.push_back(std::sqrt(one.variance[i] + other.variance[i]));
  return test::z_test_p(one.mean, other.mean, noise);
}

}  // namespace

TEST_CASE("rings and photons agree on the brushed paraboloid", "[long]") {
  const std::string file = CATOPTRIC_DATA "/examples/brushed_paraboloid.toml";
  const Scene scene = read_scene(file, {}),
              rougher = read_scene(file, {{"reflector.roughness", "0.15", "test"}});
  const auto stage_of = [](const Scene& each) {
    return std::make_unique<Stage>(each, Candidate{each.profile, each.source, each.mirror});
  };
  const auto stage = stage_of(scene), other = stage_of(rougher);
  const auto rings = [&](const Stage& on) {
    return over_sets([&](const sim::PhotonOptions& photons) {
      sim::RingsOptions options;
      options.photons = photons;
      options.replicates = 1;
      options.widest_kernel_radius_mm = kernel_mm;
      return sim::RingPhotons(on.scene, options).smoothed(radii_mm, kernel_mm);
    });
  };
  const Field map = over_sets([&](sim::PhotonOptions photons) {
    photons.stream += sets;
    return sim::simulate(stage->scene, samples(), photons, {sim::Kernel::silverman, {}, kernel_mm}).reflected;
  });
  CHECK(test::plausible(agreement(rings(*stage), map)));
  CHECK(test::rejected(agreement(rings(*other), map)));
}
