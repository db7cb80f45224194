#include <catch2/catch.hpp>

#include "base/random_stream.h"
#include "sim/disc_source.h"
#include "sim/ray_source.h"
#include "sim/simulation.h"
#include "sim/source_group.h"
#include "support/analytic_reflectors.h"
#include "support/flat_mirror.h"

/// Several sources together bring the sum of their light, by every way.

using namespace catoptric;
using namespace catoptric::sim;

namespace {

std::unique_ptr<const Source> point(const Vector3& at, double power) {
  return std::make_unique<PointSource>(at, power);
}

SourceGroup group() {
  std::vector<std::unique_ptr<const Source>> parts;
  parts.push_back(point({4, 0, 10}, 1));
  parts.push_back(std::make_unique<LambertianDisc>(Vector3(-3, 2, 8), 1.5, Vector3(0.2, 0, 1), 3.0));
  parts.push_back(point({0, -5, 12}, 0));
  return SourceGroup(std::move(parts));
}

}  // namespace

TEST_CASE("a group's numbers are its parts' sums, and its ball holds them all") {
  const SourceGroup both = group();
  const PointSource a({4, 0, 10}, 1);
  const LambertianDisc b({-3, 2, 8}, 1.5, {0.2, 0, 1}, 3);
  CHECK(both.power_w() == 4);
  CHECK_FALSE(both.is_round());
  CHECK_FALSE(both.is_sampled());
  for (const Source* part : std::initializer_list<const Source*>{&a, &b})
    CHECK((part->position_mm() - both.position_mm()).norm() + part->extent_mm() <= both.extent_mm());
  const Vector3 way = Vector3(0.3, 0.2, 1).normalized(), spot(5, 5, 30), down(0, 0, -1);
  CHECK(both.intensity_w_per_sr(way) == Approx(a.intensity_w_per_sr(way) + b.intensity_w_per_sr(way)));
  CHECK(both.unhindered_w_per_mm2(spot, down) ==
        Approx(a.unhindered_w_per_mm2(spot, down) + b.unhindered_w_per_mm2(spot, down)));
  std::vector<std::unique_ptr<const Source>> upright;
  upright.push_back(point({0, 0, 4}, 1));
  upright.push_back(std::make_unique<LambertianDisc>(Vector3(0, 0, 8), 1.5, Vector3(0, 0, -1), 3.0));
  CHECK(SourceGroup(std::move(upright)).is_round());
  CHECK_THROWS(SourceGroup({}));
}

TEST_CASE("a group's photons come from its parts in proportion to the light these send") {
  const SourceGroup both = group();
  const auto emission = both.emission();
  CHECK(emission->power_w() == 4);
  CHECK(emission->numbers() == 4);
  int of_point = 0;
  constexpr int count = 1000;
  double last = -1;
  for (int i = 0; i < count; ++i) {
    const Ray ray = emission->emit({(i + 0.5) / count, 0.3, 0.2, 0.7});
    const bool from_point = ray.origin_mm == Vector3(4, 0, 10);
    of_point += from_point;
    if (from_point) {  // what is left of the number runs evenly over the part's directions
      CHECK(ray.direction.z() > last);
      last = ray.direction.z();
    }
  }
  CHECK(of_point == count / 4);
}

TEST_CASE("a group's field is the sum of its parts' fields, direct, reflected and in the ledger", "[long]") {
  const test::FlatMirror mirror(20, 30);
  const NearField field = NearField::disc({0, 0, 0}, {0, 0, 1}, 10);
  const auto samples = field.samples(20);
  const PhotonOptions photons{1 << 20, Sampler::sobol, 5};
  const EstimateOptions kernel{Kernel::silverman, std::nullopt, 2.5};
  const SourceGroup both = group();
  const PointSource a({4, 0, 10}, 1);
  const LambertianDisc b({-3, 2, 8}, 1.5, {0.2, 0, 1}, 3);
  const auto light = [&](const Source& source) {
    return simulate({source, mirror, {0.9, 0}, field}, samples, photons, kernel);
  };
  const FieldEstimate all = light(both), of_a = light(a), of_b = light(b);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    CHECK(all.direct[i] == Approx(of_a.direct[i] + of_b.direct[i]).epsilon(1e-12));
    CHECK(all.reflected[i] == Approx(of_a.reflected[i] + of_b.reflected[i]).epsilon(0.03));
  }
  CHECK(all.energy.emitted_w == Approx(of_a.energy.emitted_w + of_b.energy.emitted_w).epsilon(1e-12));
  CHECK(all.energy.received_w == Approx(of_a.energy.received_w + of_b.energy.received_w).epsilon(0.01));
}

TEST_CASE("with one sampled source in a group photons bring the direct light of all") {
  class Down final : public RayBundle {
   public:
    std::uint64_t count() const override { return 1; }
    double extent_mm() const override { return 0; }
    Ray pick(double) const override { return {Vector3::Zero(), -Vector3::UnitZ()}; }
  };
  std::vector<std::unique_ptr<const Source>> parts;
  parts.push_back(point({0, 0, 10}, 1));
  parts.push_back(std::make_unique<RaySource>(Vector3(50, 0, 10), 1.0, std::make_shared<Down>(),
                                              Vector3::UnitZ(), Vector3::UnitX()));
  const SourceGroup both(std::move(parts));
  CHECK(both.is_sampled());
  const test::FlatMirror mirror(20, 30);
  const NearField field = NearField::disc({0, 0, 0}, {0, 0, 1}, 10);
  const std::vector<FieldSample> samples{{{1, 1, 0}, {0, 0, 1}}};
  const FieldEstimate all = simulate({both, mirror, {0, 0}, field}, samples, {1 << 20, Sampler::sobol, 5},
                                     {Kernel::silverman, std::nullopt, 2.0});
  CHECK(all.direct[0] == 0);
  CHECK(all.reflected[0] ==
        Approx(PointSource({0, 0, 10}, 1).unhindered_w_per_mm2({1, 1, 0}, {0, 0, 1})).epsilon(0.03));
}
