#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "support/catoptric_program.h"
#include "support/photometric_texts.h"
#include "support/temporary_folder.h"

using namespace catoptric::test;
using Catch::Contains;
using nlohmann::json;

namespace {

const std::string few = " --set model.photons=2048 --set model.replicates=3";

}  // namespace

TEST_CASE(
    "a picture as target: the search comes as near as anything symmetric can, and the program says so") {
  const TemporaryFolder folder;
  const Ended ended =
      program_run("design '" + examples + "fading_disc.toml' --out '" + (folder / "a").string() + "'");
  INFO(ended.output);
  REQUIRE(ended.code == 0);
  CHECK_THAT(ended.output, Contains("note: the picture is not symmetric about the axis"));
  CHECK_THAT(ended.output, Contains("Ud, least / greatest"));
  const json result = parsed(folder / "a" / "result.json");
  CHECK(result["target_notes"].size() == 2);
  // 0.0401 is the least that anything symmetric can be, over the near field; samples stand for it to a
  // hundredth
  CHECK(result["objective"]["value"] < 0.041);
  CHECK(result["objective"]["value"] > 0.0395);
  const Ended again = program_run("simulate '" + (folder / "a" / "scene.toml").string() +
                                  "' --quiet --out '" + (folder / "b").string() + "'" + few);
  INFO(again.output);
  REQUIRE(again.code == 0);
  CHECK(parsed(folder / "b" / "result.json")["target_notes"] == result["target_notes"]);
}

TEST_CASE("the near field's figures stand in the result with unit, noise, bias and interval") {
  const TemporaryFolder folder;
  const Ended ended = program_run("simulate '" + examples + "diffusing_floor.toml' --out '" +
                                  (folder / "a").string() + "' --set model.rung=photons" + few);
  INFO(ended.output);
  REQUIRE(ended.code == 0);
  const json field = parsed(folder / "a" / "result.json")["near_field"];
  for (const char* name : {"average", "least", "greatest", "uniformity", "diversity", "flux"}) {
    INFO(name);
    for (const char* part : {"value", "unit", "noise", "bias", "interval95"})
      CHECK(field[name].contains(part));
    // the darkest sample has computed light alone
    if (std::string(name) != "least") CHECK(field[name]["noise"].get<double>() > 0);
  }
  CHECK(field["average"]["unit"] == "W/m^2");
  CHECK(field["flux"]["unit"] == "W");
  CHECK(field["diversity"]["value"] < field["uniformity"]["value"]);
  double flux = 0;
  for (const json& zone : field["zones"]) flux += zone["flux"]["value"].get<double>();
  CHECK(flux == Approx(field["flux"]["value"].get<double>()).epsilon(1e-12));
  CHECK(field["samples"]["grid"] == "area");
  CHECK(field["samples"]["spacing"].size() == 2);
  CHECK_THAT(ended.output, Contains("on the near field") && Contains("apart on average"));
}

TEST_CASE("the grid of EN 12464-1 is stated in the result and printed") {
  const TemporaryFolder folder;
  const std::string example = read_whole(examples + "tilted_screen.toml");
  write_whole(folder / "grid.toml", replaced(example, "samples = 400", "grid = \"en12464\""));
  const Ended ended = program_run("simulate '" + (folder / "grid.toml").string() + "' --out '" +
                                  (folder / "a").string() + "'" + few);
  INFO(ended.output);
  REQUIRE(ended.code == 0);
  // 90 mm by 70 mm: p = 0.2 * 5^(log10 0.09) = 0.037 m, so 3 by 2 cells
  const json samples = parsed(folder / "a" / "result.json")["near_field"]["samples"];
  CHECK(samples["grid"] == "en12464");
  CHECK(samples["number"] == 6);
  CHECK(samples["unit"] == "mm");
  CHECK(samples["spacing"][0].get<double>() == Approx(30));
  CHECK(samples["spacing"][1].get<double>() == Approx(35));
  CHECK_THAT(ended.output, Contains("6 on the grid of EN 12464-1, 30 by 35 mm apart"));
  const Ended again = program_run("simulate '" + (folder / "a" / "scene.toml").string() +
                                  "' --quiet --out '" + (folder / "b").string() + "'");
  REQUIRE(again.code == 0);
  CHECK(repeatable(folder / "b" / "result.json") == repeatable(folder / "a" / "result.json"));
  const Ended both =
      program_run("simulate '" + examples + "tilted_screen.toml' --set near_field.grid=en12464");
  CHECK(both.code == 3);
  CHECK_THAT(both.output, Contains("near_field.samples") && Contains("3 by 2 points"));
}

TEST_CASE("an IES file says what is wanted from afar") {
  const TemporaryFolder folder;
  write_whole(folder / "lamp.ies", sound_ies());
  const std::string file = " --set \"target.intensity_file='" + (folder / "lamp.ies").string() + "'\"";
  const auto design = [&](const std::string& out, const std::string& more) {
    return program_run("design '" + paper + "start_a.toml' --out '" + (folder / out).string() + "'" + small +
                       " --set model.interactions=4" + file + more);
  };
  const Ended mixed = design("mixed", " --set search.metric=intensity-rmse");
  CHECK(mixed.code == 3);
  CHECK_THAT(mixed.output, Contains("cd in a scene of W"));
  const Ended absolute =
      design("absolute", " --set target.intensity_scale=free --set search.metric=intensity-rmse");
  CHECK(absolute.code == 3);
  CHECK_THAT(absolute.output, Contains("relative-intensity-rmse"));
  const Ended done =
      design("done", " --set target.intensity_scale=free --set search.metric=relative-intensity-rmse");
  INFO(done.output);
  REQUIRE(done.code == 0);
  CHECK_THAT(done.output, Contains("not alike in all C planes"));
  const json result = parsed(folder / "done" / "result.json");
  const json &best = result["metrics"]["relative-intensity-rmse"],
             &start = result["start"]["metrics"]["relative-intensity-rmse"];
  CHECK(result["objective"]["value"] == best["value"]);
  CHECK(best["value"].get<double>() < start["value"].get<double>());
  CHECK(best["value"].get<double>() < 1);
  CHECK(best["unit"] == "1");
  CHECK(result["metrics"]["intensity-rmse"]["unit"] == "W/sr");
}
