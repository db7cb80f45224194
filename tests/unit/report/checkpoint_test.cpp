#include <catch2/catch.hpp>
#include <limits>
#include <nlohmann/json.hpp>
#include <thread>

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
  const TemporaryFolder folder;
  report::Checkpoint checkpoint(scene(), folder.path());
  optim::SearchTape tape;
  using Clock = std::chrono::steady_clock;
  std::vector<Clock::duration> writes;
  tape.grown = [&](const optim::SearchTape& grown) {
    const auto begin = Clock::now();
    if (checkpoint.keep(grown)) writes.push_back(Clock::now() - begin);
  };
  for (int i = 0; i < 3; ++i) {
    tape.record(std::array{1.0 * i}, 1);
    CHECK(writes.size() == static_cast<std::size_t>(i + 1));
    CHECK(saved_answers(checkpoint.path()) == tape.answers().size());
    std::this_thread::sleep_for(std::chrono::seconds(1));  // 20 times the 50 ms that a slow disk may take
  }
  writes.clear();
  const auto begin = Clock::now();
  while (tape.answers().size() < 1000 || writes.size() < 2) {
    tape.record(std::array{0.5}, 1);
    std::this_thread::sleep_for(std::chrono::microseconds(100));
  }
  const auto spent = Clock::now() - begin;
  CHECK(writes.size() < tape.answers().size() / 2);
  // Each write but the last has been paid for by twenty times its cost before the next.
  Clock::duration paid{};
  for (std::size_t i = 0; i + 1 < writes.size(); ++i) paid += writes[i];
  CHECK(19 * paid < spent);
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
