#include <catch2/catch.hpp>
#include <chrono>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "report/run_checkpoint.h"
#include "support/temporary_folder.h"

using namespace catoptric;
using catoptric::test::read_whole;
using catoptric::test::TemporaryFolder;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

design::Scene scene(const std::vector<design::Override>& changed = {}) {
  return design::read_scene(std::string(CATOPTRIC_DATA) + "/paper/start_a.toml", changed);
}

std::size_t saved_answers(const std::filesystem::path& file) {
  return nlohmann::json::parse(read_whole(file))["answers"].size();
}

}  // namespace

TEST_CASE("a checkpoint gives back every answer bit for bit") {
  const TemporaryFolder folder;
  report::Checkpoint checkpoint(scene(), folder.path());
  CHECK_FALSE(checkpoint.exists());
  const std::vector<optim::Answer> answers{{{0.1, 1.0 / 3}, 1e-320},
                                           {{-0.0, 5e-324}, infinity},
                                           {{1e308, 0x1.fffffffffffffp-1}, 1e100 * 1.1},
                                           {{2, 3}, 0x1.0000000000001p0}};
  checkpoint.write(optim::SearchTape(answers));
  CHECK(checkpoint.exists());
  const std::vector<optim::Answer> read = checkpoint.read();
  CHECK(read == answers);
  CHECK(std::signbit(read[1].x[0]));
  const auto saved = nlohmann::json::parse(read_whole(checkpoint.path()));
  CHECK(saved["best"]["search_value"] == 1e-320);
  CHECK(saved["best"]["variables"] == nlohmann::json({0.1, 1.0 / 3}));
  checkpoint.remove();
  CHECK_FALSE(checkpoint.exists());
}

TEST_CASE("slow evaluations are all saved, quick ones so seldom that saving is a twentieth of the time") {
  using namespace std::chrono_literals;
  const TemporaryFolder folder;
  report::Checkpoint::Clock::time_point time{1h};
  auto tick = 0ms;  // each look at the clock takes this long, so that a write, which looks twice, does too
  report::Checkpoint checkpoint(scene(), folder.path(), [&] { return time += tick; });
  optim::SearchTape tape;
  std::vector<std::size_t> saved;
  tape.grown = [&](const optim::SearchTape& grown) {
    if (!checkpoint.keep(grown)) return;
    saved.push_back(grown.answers().size());
    CHECK(saved_answers(checkpoint.path()) == grown.answers().size());
  };
  const auto evaluate = [&](int times, std::chrono::milliseconds cost) {
    for (int i = 0; i < times; ++i) {
      time += cost;
      tape.record(std::array{1.0 * i}, 1);
    }
  };
  SECTION("the first answer, and each that took twenty times what a write takes") {
    tick = 10ms;
    evaluate(4, 200ms);
    CHECK(saved == std::vector<std::size_t>{1, 2, 3, 4});
  }
  SECTION("a write of 10 ms is paid for by 200 ms") {
    tick = 10ms;
    evaluate(1, 0ms);
    tick = 0ms;
    evaluate(199, 1ms);
    CHECK(saved == std::vector<std::size_t>{1});
    evaluate(1, 1ms);
    CHECK(saved == std::vector<std::size_t>{1, 201});
  }
  SECTION("a disk that became quick is trusted again") {
    tick = 10ms;
    evaluate(1, 0ms);
    tick = 0ms;
    evaluate(1, 200ms);  // a write that takes no time
    evaluate(3, 1ms);
    CHECK(saved == std::vector<std::size_t>{1, 2, 3, 4, 5});
  }
}

TEST_CASE("a checkpoint is of its scene, but for budget, threads and title") {
  const TemporaryFolder folder;
  report::Checkpoint(scene(), folder.path()).write(optim::SearchTape({{{1, 2}, 3}}));
  const auto read = [&](const char* key, const char* value) {
    return report::Checkpoint(scene({{key, value, "test"}}), folder.path()).read().size();
  };
  CHECK(read("threads", "7") == 1);
  CHECK(read("title", "another") == 1);
  CHECK(read("search.most_evaluations", "77") == 1);
  CHECK(read("search.most_iterations", "77") == 1);
  for (const auto& [key, value] : {std::pair{"seed", "2"}, std::pair{"source.power", "39.9"},
                                   std::pair{"variables.w1.start", "1.61"}, std::pair{"search.reach", "0.1"}})
    CHECK_THROWS_WITH(read(key, value), Catch::Contains("of another scene"));
}
