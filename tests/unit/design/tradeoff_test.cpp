#include "design/tradeoff.h"

#include <catch2/catch.hpp>
#include <set>

using namespace catoptric;
using namespace catoptric::design;

namespace {

const std::string data = CATOPTRIC_DATA;

TradeRow row(double seconds, double error) {
  TradeRow made{};
  made.seconds = seconds;
  made.error_rel = made.greatest_error_rel = error;
  return made;
}

}  // namespace

TEST_CASE("the front holds what no other setting beats in time and error") {
  std::vector<TradeRow> rows{row(1, 0.1),  row(2, 0.1),   row(2, 0.01),
                             row(3, 0.02), row(4, 0.001), row(1, 0.1)};
  mark_front(rows);
  std::vector<bool> front;
  for (const TradeRow& each : rows) front.push_back(each.on_front);
  // equals do not beat each other
  CHECK(front == std::vector<bool>{true, false, true, false, true, true});
}

TEST_CASE("the choice is the cheapest that kept the accuracy, the reference's own error included") {
  const std::vector<TradeRow> rows{row(1, 0.5), row(2, 0.05), row(3, 0.0099), row(4, 0.0005)};
  const auto exact = choose(rows, 0, {0.1, 0.01, 0.0001});
  CHECK(exact[0].row == std::size_t{1});
  CHECK(exact[1].row == std::size_t{2});
  CHECK_FALSE(exact[2].row);
  CHECK(choose(rows, 0.001, {0.01})[0].row == std::size_t{3});
}

TEST_CASE("settings cover the rungs that the scene allows, each said in words") {
  const auto rungs_of = [](const std::string& file) {
    const Scene scene = read_scene(data + file);
    std::set<sim::Rung> rungs;
    std::set<std::string> texts;
    for (const TradeSetting& setting : trade_settings(scene, start_profile(scene))) {
      rungs.insert(setting.rung);
      CHECK(texts.insert(words(scene, setting)).second);  // no setting twice
    }
    return rungs;
  };
  CHECK(rungs_of("/paper/paraboloid.toml").size() == 3);
  CHECK(rungs_of("/examples/diffusing_floor.toml") == std::set{sim::Rung::rings, sim::Rung::photons});
  CHECK(rungs_of("/examples/tilted_screen.toml") == std::set{sim::Rung::photons});
}
