#include <catch2/catch.hpp>
#include <functional>

#include "base/units.h"
#include "design/sensitivity.h"
#include "design/thread_limit.h"
#include "design/tradeoff.h"
#include "support/ladder_scenes.h"
#include "support/result_numbers.h"
#include "support/scaled_scene.h"
#include "support/temporary_folder.h"

/// The scene as a whole made larger or smaller: lengths times s, so irradiances over s squared. By powers of
/// two nothing may change, not a bit, whatever is asked and by however many threads; by others, and in other
/// units, nothing but rounding.
using namespace catoptric;
using namespace catoptric::design;
using test::Keys;
using test::Magnitudes;
using test::ResultNumbers;

namespace {

/// How a scene of scale 1 in mm is written.
struct Writing {
  double scale = 1;
  LengthUnit unit = LengthUnit::millimetre;

  Scene scene(const std::string& text, const Keys& keys) const {
    const std::string head = fmt::format("unit = \"{}\"\n", symbol(unit));
    return test::scene_of(head + test::scaled_text(text, scale, millimetres_per(unit)), keys);
  }
  ResultNumbers numbers(const Scene& scene) const {
    const double power = scene.source.power_w, area = scene.near_field.area_mm2() / (scale * scale);
    return ResultNumbers(Magnitudes{100, power / area, power}, scale, millimetres_per(unit));
  }
};

struct Case {
  std::string name;
  std::function<ResultNumbers(const Writing&)> run;
  double rounding = 1e-10;  ///< how far other numbers for the same scene may move it, of its own size
};

Case simulating(std::string name, std::string text, Keys keys, double rounding = 1e-10) {
  const auto run = [text = std::move(text), keys = std::move(keys)](const Writing& writing) {
    const Scene scene = writing.scene(text, keys);
    const SimulationResult result = run_simulation(scene, {});
    ResultNumbers numbers = writing.numbers(scene);
    numbers.add(result.target);
    numbers.add(result.mirror, scene.search.metric);
    return numbers;
  };
  return {std::move(name), run, rounding};
}

/// The same aimed at a table, whose lengths and irradiances are written like the scene's.
Case aiming(const std::string& scene, const std::string& kind, std::string table) {
  const std::string text = scene + "[target]\nkind = \"" + kind + "\"\n";
  const auto run = [kind, text, table = std::move(table)](const Writing& writing) {
    const test::TemporaryFolder folder;
    test::write_whole(folder / "table.csv",
                      test::scaled_text(table, writing.scale, millimetres_per(writing.unit)));
    return simulating({}, text, {{"target.file", (folder / "table.csv").string()}}).run(writing);
  };
  return {kind + " table", run};
}

/// @in whole: every step of the search, not only its end
Case designing(std::string name, std::string text, Keys keys, bool whole) {
  const auto run = [text = std::move(text), keys = std::move(keys), whole](const Writing& writing) {
    const Scene scene = writing.scene(text, keys);
    const DesignResult result = run_design(scene, {});
    ResultNumbers numbers = writing.numbers(scene);
    numbers.add(result.target);
    if (whole) numbers.add(result.search, result.best.names, scene.search.metric);
    numbers.add(result.start, scene.search.metric);
    numbers.add(result.best, scene.search.metric);
    return numbers;
  };
  // Trials are compared with each other, and each is good to the roundings of a simulation.
  return {std::move(name), run, 1e-7};
}

Case sensing(std::string name, std::string text) {
  const auto run = [text = std::move(text)](const Writing& writing) {
    const Scene scene = writing.scene(text, {{"sensitivity.modes", "2"}, {"model.photons", "500"}});
    const Sensitivity result = run_sensitivity(scene, {});
    ResultNumbers numbers = writing.numbers(scene);
    numbers.irradiance(result.field_rms_w_per_mm2);
    numbers.irradiances(result.field_w_per_mm2);
    for (const ParameterSensitivity& each : result.parameters) {
      const bool length = each.deviation.unit == symbol(scene.unit);
      const double unit_mm = length ? millimetres_per(scene.unit) : 1.0;
      for (const double value : {each.tolerance().value_or(-1), each.step})
        length ? numbers.length(value * unit_mm) : numbers.plain(value);
      for (const double slope : each.derivative_w_per_mm2)
        numbers.irradiance(length ? slope * writing.scale / unit_mm : slope);
    }
    return numbers;
  };
  // Differences of fields over small steps, a hundredth of their size.
  return {std::move(name), run, 1e-7};
}

Case trading() {
  return {"tradeoff",
          [](const Writing& writing) {
            const Scene scene = writing.scene(
                test::paper_scene,
                {{"tradeoff.seconds", "1000"}, {"tradeoff.seeds", "2"}, {"tradeoff.most_photons", "3000"}});
            const Tradeoff result = run_tradeoff(scene, {});
            ResultNumbers numbers = writing.numbers(scene);
            numbers.plain(result.reference_error_rel);
            for (const TradeRow& row : result.rows) numbers.plain(row.error_rel);
            return numbers;
          },
          1e-7};
}

Case drawing() {
  const std::string text =
      test::paper_scene +
      "[landscape]\nvariables = [\"w1\", \"r2\"]\nlower = [0.7, @75]\nupper = [2, @120]\nsteps = [5, 5]\n";
  return {"landscape", [=](const Writing& writing) {
            const Scene scene = writing.scene(text, {});
            ResultNumbers numbers = writing.numbers(scene);
            for (const double value : run_landscape(scene, {}).objective) numbers.metric(Metric::rmse, value);
            return numbers;
          }};
}

std::vector<Case> simulations() {
  std::vector<Case> list;
  for (const char* rung : {"tubes", "rings", "photons"})
    list.push_back(simulating(std::string("paper by ") + rung, test::paper_scene, {{"model.rung", rung}}));
  for (const char* rung : {"rings", "photons"}) {
    list.push_back(simulating(std::string("floor by ") + rung, test::floor_scene, {{"model.rung", rung}}));
    list.push_back(simulating(std::string("disc by ") + rung, test::disc_scene, {{"model.rung", rung}}));
  }
  list.push_back(simulating("aside, random, nearest ones", test::aside_scene,
                            {{"model.sampler", "random"}, {"model.neighbours", "20"}}));
  for (const char* engine : {"meridian", "mesh"})
    list.push_back(
        simulating(std::string("aside, ") + engine, test::aside_scene, {{"model.engine", engine}}));
  const Keys by_occt{{"model.engine", "occt"}, {"model.photons", "60"}, {"model.replicates", "2"}};
  list.push_back(simulating("paper, occt", test::paper_scene, by_occt));
  // A photon of it grazes the mirror, where the reference's hits are good to the root of a rounding.
  list.push_back(simulating("aside, occt", test::aside_scene, by_occt, 1e-7));
  list.push_back(aiming(test::aside_scene, "csv",
                        "x,y,z,irradiance\n@10,0,@-40,%50\n@30,0,@-40,%70\n@-20,0,@-40,%20\n"));
  list.push_back(aiming(test::floor_scene, "radial", "radius,irradiance\n0,%50\n@20,%70\n@60,%10\n"));
  for (const auto& [name, text] : {std::pair{"paper", test::paper_scene},
                                   {"aside", test::aside_scene},
                                   {"floor", test::floor_scene},
                                   {"disc", test::disc_scene}})
    list.push_back(simulating(std::string("accuracy, ") + name, text, {{"accuracy", "0.05"}}));
  list.push_back(simulating("accuracy, paper by photons", test::paper_scene,
                            {{"accuracy", "0.05"}, {"model.rung", "photons"}}));
  return list;
}

/// Searches, tailoring of listed variables, of a whole profile and from nothing.
std::vector<Case> designs(bool whole) {
  std::vector<Case> list;
  const auto add = [&](const std::string& name, const std::string& text, const Keys& keys) {
    list.push_back(designing(name, text, keys, whole));
  };
  for (const char* method :
       {"hooke-jeeves", "levenberg-marquardt", "nelder-mead", "compass", "differential-evolution",
        "self-adaptive-de", "particle-swarm", "simulated-annealing", "genetic"})
    add(method, test::paper_scene, {{"search.method", method}, {"search.most_evaluations", "80"}});
  const std::string few = "40";
  add("restarts", test::paper_scene, {{"search.restarts", "2"}, {"search.most_evaluations", "150"}});
  add("free profile", test::paper_scene, {{"search.free", "profile"}, {"search.most_evaluations", few}});
  add("curvature", test::paper_scene, {{"search.free", "curvature"}, {"search.most_evaluations", few}});
  add("refinement", test::paper_scene,
      {{"search.free", "profile"},
       {"search.refine", "[\"degree 3\", \"spans 2\"]"},
       {"search.most_evaluations", few}});

  add("tailored variables", test::paper_scene, {{"start", "tailored"}, {"search.method", "none"}});
  add("tailored profile", test::paper_scene,
      {{"start", "tailored"}, {"search.free", "profile"}, {"search.method", "none"}});
  add("from nothing", test::nothing_scene, {});
  add("from nothing, free scale", test::nothing_scene, {{"target.scale", "free"}});
  return list;
}

/// What magnifies roundings, so that only powers of two are asked of it: populations whose ranks, and a
/// family of mirrors with the same light along which ends, a rounding decides; photons in the loop of a
/// compensation.
std::vector<Case> touchy_designs() {
  std::string disc = test::nothing_scene;
  disc.replace(disc.find("power = 10"), 10, "power = 10\nkind = \"disc\"\nradius = @5");
  return {designing("cma-es", test::paper_scene,
                    {{"search.method", "cma-es"}, {"search.most_evaluations", "80"}}, true),
          designing("free profile by Levenberg-Marquardt", test::paper_scene,
                    {{"search.free", "profile"},
                     {"search.method", "levenberg-marquardt"},
                     {"search.most_evaluations", "40"}},
                    true),
          designing("from nothing for a disc", disc, {}, true)};
}

ResultNumbers by_threads(int threads, const Case& each, double scale) {
  const ThreadLimit limit(threads);
  return each.run({scale});
}

void check_bits(const Case& each) {
  const ResultNumbers plain = by_threads(1, each, 1);
  INFO(each.name);
  CHECK(plain.size() > 20);
  CHECK(ResultNumbers::differing(plain, by_threads(2, each, 0x1p-10)) == 0);
  CHECK(ResultNumbers::differing(plain, by_threads(7, each, 0x1p10)) == 0);
}

void check_rounding(const Case& each) {
  const ResultNumbers plain = each.run({});
  INFO(each.name);
  double worst = 0;
  for (const Writing& writing :
       {Writing{1e-3}, Writing{1e3}, Writing{1, LengthUnit::centimetre}, Writing{1, LengthUnit::metre},
        Writing{1, LengthUnit::inch}, Writing{25.4, LengthUnit::inch}}) {
    INFO("times " << writing.scale << " in " << symbol(writing.unit));
    const double off = ResultNumbers::distance(plain, each.run(writing));
    CHECK(off <= each.rounding);
    worst = std::max(worst, off);
  }
  fmt::print("{:32} {:.1e}, allowed {:.0e}\n", each.name, worst, each.rounding);
}

}  // namespace

TEST_CASE("simulations are the same bits at any power of two and by 1, 2 and 7 threads", "[scale][long]") {
  for (const Case& each : simulations()) check_bits(each);
}

TEST_CASE("designs take the same steps at any power of two and by 1, 2 and 7 threads", "[scale][long]") {
  for (const Case& each : designs(true)) check_bits(each);
  for (const Case& each : touchy_designs()) check_bits(each);
}

TEST_CASE("sensitivity and landscape are the same bits at any power of two and by 1, 2 and 7 threads",
          "[scale][long]") {
  check_bits(sensing("sensitivity of the paper's", test::paper_scene));
  check_bits(sensing("sensitivity of a disc's", test::disc_scene));
  check_bits(drawing());
}

TEST_CASE("a trade-off's errors are the same bits at any power of two and by 1, 2 and 7 threads",
          "[scale][.long]") {
  check_bits(trading());
}

TEST_CASE("a thousand times smaller or larger, or in another unit, changes roundings only", "[scale][long]") {
  for (const Case& each : simulations()) check_rounding(each);
  for (const Case& each : designs(false)) check_rounding(each);
  check_rounding(sensing("sensitivity", test::paper_scene));
  check_rounding(drawing());
}
