#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "base/errors.h"
#include "base/random_stream.h"
#include "base/units.h"
#include "sim/disc_source.h"
#include "sim/ray_source.h"
#include "sim/simulation.h"
#include "support/flat_mirror.h"
#include "support/statistics.h"

/// Sources that are known by rays alone: the light they bring, and what is said of its noise.

using namespace catoptric;
using namespace catoptric::sim;

namespace {

/// Rays of a source, all of them as bright.
class ListedRays final : public RayBundle {
 public:
  ListedRays(const Source& source, std::uint64_t count, std::uint64_t seed) : extent_mm_(source.extent_mm()) {
    const auto emission = source.emission();
    for (std::uint64_t i = 0; i < count; ++i) {
      RandomStream stream(seed, Purpose::test, i);
      const double a = stream.uniform(), b = stream.uniform(), c = stream.uniform(), d = stream.uniform();
      rays_.push_back(emission->emit({a, b, c, d}));
    }
  }
  std::uint64_t count() const override { return rays_.size(); }
  double extent_mm() const override { return extent_mm_; }
  Ray pick(double number) const override { return rays_[index(number)]; }
  std::size_t index(double number) const {
    return static_cast<std::size_t>(number * static_cast<double>(rays_.size()));
  }

 private:
  std::vector<Ray> rays_;
  double extent_mm_;
};

constexpr double power = 5, reflectance = 0.7;

/// A disc that shines sideways between a mirror above it and a field below.
struct Room {
  LambertianDisc disc{{0, 0, 0}, 2, {0, 0, 1}, power};  ///< in the bundle's own frame
  Vector3 place{1, 2, 10}, axis = Vector3(0.3, 0, 1).normalized(), along{1, 0.2, 0};
  test::FlatMirror mirror{20, 60};
  NearField field = NearField::disc({0, 0, 0}, {0, 0, 1}, 10);

  FieldEstimate light(const std::shared_ptr<const RayBundle>& rays, std::span<const FieldSample> samples,
                      std::uint64_t photons, std::uint64_t stream, double kernel_mm) const {
    const RaySource source(place, power, rays, axis, along);
    return simulate({source, mirror, {reflectance, 0}, field}, samples, {photons, Sampler::sobol, 4, stream},
                    {Kernel::silverman, std::nullopt, kernel_mm});
  }

  /// By the disc itself: nothing goes straight down, all goes by way of the mirror.
  double wanted(const FieldSample& sample) const {
    const LambertianDisc there(place, 2, axis, power),
        image({place.x(), place.y(), 40 - place.z()}, 2, {axis.x(), axis.y(), -axis.z()}, power);
    return there.unhindered_w_per_mm2(sample.point_mm, sample.normal) +
           reflectance * image.unhindered_w_per_mm2(sample.point_mm, sample.normal);
  }
};

}  // namespace

TEST_CASE("rays of a known source bring its light, by way of the mirror and straight") {
  Room room;
  const std::vector<FieldSample> samples = room.field.samples(12);
  for (const bool downwards : {false, true}) {
    CAPTURE(downwards);
    if (downwards) room.axis = Vector3(0.3, 0, -1).normalized();
    const auto rays = std::make_shared<const ListedRays>(room.disc, 400'000, 7);
    std::vector<FieldEstimate> sets;
    for (std::uint64_t stream = 1; stream <= parts_of_a_bundle; ++stream)
      sets.push_back(room.light(rays, samples, 1 << 16, stream, 1.5));
    for (std::size_t i = 0; i < samples.size(); ++i) {
      std::vector<double> values;
      for (const FieldEstimate& set : sets) {
        values.push_back(set.reflected[i]);
        CHECK(set.direct[i] == 0);
      }
      CHECK(test::plausible(test::student_p(values, room.wanted(samples[i]))));
    }
    const EnergyLedger& energy = sets.front().energy;
    CHECK(energy.emitted_w == power);
    CHECK(energy.missed_w + energy.absorbed_w + energy.received_w + energy.escaped_w + energy.cut_off_w ==
          Approx(power).epsilon(1e-12));
    CHECK((downwards ? energy.absorbed_w < 0.05 * power : energy.absorbed_w > 0.2 * power));
  }
}

TEST_CASE("sets of photons show the noise of the rays themselves, and sets that share their rays do not",
          "[long]") {
  const Room room;
  const std::vector<FieldSample> samples{{{0, 0, 0}, {0, 0, 1}}};
  const double wanted = room.wanted(samples.front());
  double shared = 0, apart = 0;
  constexpr int files = 12;
  for (std::uint64_t file = 0; file < files; ++file) {
    const auto rays = std::make_shared<const ListedRays>(room.disc, 3000, 20 + file);
    std::vector<double> independent, same;
    for (std::uint64_t set = 0; set < parts_of_a_bundle; ++set) {
      independent.push_back(room.light(rays, samples, 1 << 15, 1 + set, 4).reflected[0]);
      same.push_back(room.light(rays, samples, 1 << 15, 1 + set * parts_of_a_bundle, 4).reflected[0]);
    }
    // Fisher's sum over the files, each of which is another draw of the same source.
    apart -= 2 * std::log(test::student_p(independent, wanted));
    shared -= 2 * std::log(test::student_p(same, wanted));
  }
  const boost::math::chi_squared fisher(2 * files);
  CHECK(test::plausible(boost::math::cdf(boost::math::complement(fisher, apart))));
  CHECK(test::rejected(boost::math::cdf(boost::math::complement(fisher, shared))));
}

TEST_CASE("parts of a bundle share few rays, and together they are all of it") {
  const LambertianDisc disc({0, 0, 0}, 1, {0, 0, 1}, 1);
  class Watched final : public RayBundle {
   public:
    std::uint64_t count() const override { return 6400; }
    double extent_mm() const override { return 0; }
    Ray pick(double number) const override {
      picked.insert(static_cast<int>(number * 6400));
      return {Vector3::Zero(), Vector3::UnitZ()};
    }
    mutable std::set<int> picked;
  };
  const auto watched = std::make_shared<Watched>();
  const RaySource source({0, 0, 0}, 1, watched, {0, 0, 1}, {1, 0, 0});
  const auto emission = source.emission();
  std::multiset<int> all;
  for (std::uint64_t stream = 1; stream <= parts_of_a_bundle; ++stream) {
    watched->picked.clear();
    for (int i = 0; i < 64'000; ++i) emission->emit({(i + 0.5) / 64'000, 0, 0, 0}, stream);
    CHECK(watched->picked.size() <= 6400 / parts_of_a_bundle);
    all.insert(watched->picked.begin(), watched->picked.end());
  }
  CHECK(all.size() == 6400);
  CHECK(std::set<int>(all.begin(), all.end()).size() == 6400);
  watched->picked.clear();
  for (int i = 0; i < 64'000; ++i) emission->emit({(i + 0.5) / 64'000, 0, 0, 0}, 0);
  CHECK(watched->picked.size() == 6400);
  CHECK_THROWS_AS(RaySource({0, 0, 0}, 1, watched, {0, 0, 1}, {0, 0, 2}), InputError);
}
