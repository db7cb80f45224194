#include "design/shared_work.h"

#include <catch2/catch.hpp>

#include "base/byte_record.h"
#include "design/memory_need.h"
#include "sim/bandwidth_ladder.h"

using namespace catoptric;
using namespace catoptric::design;

namespace {

class SoManyRanks : public Ranks {
 public:
  explicit SoManyRanks(int size) : size_(size) {}
  int size() const override { return size_; }

 private:
  int size_;
};

Scene scene_with(const char* photons, const char* replicates) {
  return read_scene(std::string(CATOPTRIC_DATA) + "/paper/paraboloid.toml",
                    {{"model.photons", photons, "test"},
                     {"model.replicates", replicates, "test"},
                     {"model.kernel_radius", "0.5", "test"}});
}

}  // namespace

TEST_CASE("explain says what ranks share") {
  const auto words = [](const char* photons, int ranks, std::optional<sim::Rung> searched) {
    return sharing_sentence(scene_with(photons, "8"), searched, SoManyRanks(ranks));
  };
  CHECK(words("100000", 1, {}).empty());
  CHECK(words("100000", 64, {}) == "64 ranks: the 8 replicates of a verdict are shared");
  CHECK(words("1000000000", 64, sim::Rung::photons) ==
        "64 ranks: the 60 batches of photons of each of 8 replicates of a verdict are shared; a search "
        "computes "
        "up to 64 points that it may ask for side by side");
  CHECK(words("100000", 4, sim::Rung::tubes).find("the search is rank 0's alone") != std::string::npos);
}

TEST_CASE("what ranks send each other is read back as it was") {
  optim::Outcome outcome{};
  outcome.ending = optim::Ending::evaluation_limit;
  outcome.sentence = "stopped";
  outcome.best = {1.5, -2};
  outcome.value = 0.25;
  outcome.start_value = 4;
  outcome.successes = 1;
  outcome.iterations = 2;
  outcome.evaluations = 3;
  outcome.cache_hits = 4;
  outcome.restarts = 5;
  outcome.history = {{0, 1, 2, 0.5, "start", {1, 2}, 4}, {1, 2, 3, 0.25, "pattern", {1.5, -2}, 0.25}};
  const optim::Outcome again = outcome_of(as_bytes(outcome));
  CHECK(as_bytes(again) == as_bytes(outcome));
  CHECK(again.restarts == 5);
  CHECK(again.history.back().move == "pattern");
  CHECK(again.history.back().x == outcome.best);

  sim::AccurateField field;
  field.sentence = "proven";
  field.breaks = "an edge";
  field.by_set = {{1, 2}, {3}};
  field.stages = {{512, 0.5}, {1024, 0.25}};
  field.counts.interactions = 7;
  const sim::AccurateField known = accurate_field_of(as_bytes(field));
  CHECK(known.breaks == field.breaks);
  CHECK(known.by_set == field.by_set);
  CHECK(known.stages.back().error95_rel == 0.25);
  CHECK(known.counts.interactions == 7);
  CHECK(as_bytes(known) == as_bytes(field));
}

TEST_CASE("ranks that keep an accuracy's photons need memory for their part of them") {
  const Scene scene = read_scene(std::string(CATOPTRIC_DATA) + "/paper/paraboloid.toml",
                                 {{"model.rung", "\"photons\"", "test"},
                                  {"accuracy", "0.01", "test"},
                                  {"model.most_photons", "400000000", "test"}});
  const auto alone = memory_need(scene).bytes, of_four = memory_need(scene, 4).bytes,
             of_many = memory_need(scene, 1000).bytes;
  CHECK(alone > 400'000'000 * 17ull);
  CHECK(of_four < alone / 3);
  CHECK(of_four > alone / 5);
  CHECK(of_many < of_four);
  CHECK(sim::most_kept_by_a_rank(1000, 1) == 1000);
  CHECK(sim::most_kept_by_a_rank(1000, 3) == 500);  // four sets of one slice each
  CHECK(sim::most_kept_by_a_rank(1000, 9) == 250);  // one set at least
}
