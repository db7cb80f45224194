#include <catch2/catch.hpp>

#include "sim/bandwidth_ladder.h"
#include "sim/photon_map.h"
#include "support/analytic_reflectors.h"

using namespace catoptric;
using namespace catoptric::sim;

namespace {

const auto mirror = test::paraboloid();
const PointSource source({10, 0, 50}, 40);
const auto field = NearField::rectangle({5, 0, 0}, Vector3(0.1, 0, 1).normalized(), {0, 1, 0}, 100, 80);
const Scene scene{source, mirror, {0.9, 0.0}, field};
constexpr double widest_mm = 9;

/// Ranks one after the other in one process.
class InTurn : public Ranks {
 public:
  explicit InTurn(std::size_t size) : size_(size) {}
  int size() const override { return static_cast<int>(size_); }
  std::vector<Bytes> each(const ComputeOwn& compute) override {
    std::vector<Bytes> all;
    for (std::size_t rank = 0; rank < size_; ++rank) all.push_back(compute(rank, size_));
    return all;
  }

 private:
  std::size_t size_;
};

}  // namespace

TEST_CASE("photon sets kept in slices show what one map of all photons shows, by any number of ranks",
          "[long]") {
  const auto samples = field.samples(40);
  // Two slices, of which the second has a chunk that is not full.
  PhotonOptions photons{(std::uint64_t{1} << 21) + 777, Sampler::random, 3, 2, 1000};
  PhotonSets alone(scene, Rung::photons);
  alone.fly(photons, 2, widest_mm);
  const SetFields fields = alone.fields(samples, widest_mm, 2), fourth = alone.fields(samples, widest_mm, 4);
  const BandwidthLadder ladder = alone.look(samples, widest_mm, 4);
  REQUIRE(fields.size() == 2);
  for (std::size_t set = 0; set < 2; ++set) {
    PhotonOptions of_set = photons;
    of_set.stream += set;
    const PhotonMap whole(field, trace_photons(scene, of_set, widest_mm));
    const auto expected = whole.ladder(samples, widest_mm, 2);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      // thousands of photons a sample, added in another order
      CHECK(fields[set][i] == Approx(expected[0][i]).epsilon(1e-12).margin(1e-300));
      CHECK(fourth[set][i] == Approx(2 * expected[1][i] - expected[0][i]).epsilon(1e-11).margin(1e-300));
    }
    CHECK(fields[set][20] > 0);
  }
  CHECK(alone.counts().emitted == 2 * photons.photons);
  CHECK(alone.energy().emitted_w == Approx(alone.energy().missed_w + alone.energy().absorbed_w +
                                           alone.energy().received_w + alone.energy().escaped_w));
  for (const std::size_t size : {2, 3, 7}) {
    InTurn ranks(size);
    photons.ranks = &ranks;
    PhotonSets shared(scene, Rung::photons);
    shared.fly(photons, 2, widest_mm);
    CHECK(shared.fields(samples, widest_mm, 2) == fields);
    CHECK(shared.fields(samples, widest_mm, 4) == fourth);
    CHECK(shared.light_by_cell() == alone.light_by_cell());
    CHECK(shared.energy().received_w == alone.energy().received_w);
    const BandwidthLadder seen = shared.look(samples, widest_mm, 4);
    REQUIRE(seen.size() == ladder.size());
    for (std::size_t level = 0; level < seen.size(); ++level)
      CHECK(seen[level].fourth == ladder[level].fourth);
  }
}

TEST_CASE("sets of rings on any number of ranks are the sets of one process") {
  const PointSource on_axis({0, 0, 50}, 40);
  const auto across = NearField::disc({0, 0, 0}, Vector3::UnitZ(), 50);
  const Scene round{on_axis, mirror, {}, across};
  const auto samples = across.samples(30);
  PhotonOptions photons{20'000, Sampler::sobol, 3, 2, 1000};
  PhotonSets alone(round, Rung::rings);
  alone.fly(photons, 4, widest_mm);
  const BandwidthLadder ladder = alone.look(samples, widest_mm, 12);
  for (const std::size_t size : {3, 5}) {
    InTurn ranks(size);
    photons.ranks = &ranks;
    PhotonSets shared(round, Rung::rings);
    shared.fly(photons, 4, widest_mm);
    const BandwidthLadder seen = shared.look(samples, widest_mm, 12);
    REQUIRE(seen.size() == ladder.size());
    for (std::size_t level = 0; level < seen.size(); ++level)
      CHECK(seen[level].second == ladder[level].second);
    CHECK(shared.light_by_cell() == alone.light_by_cell());
    CHECK(shared.counts().stored == alone.counts().stored);
  }
}
