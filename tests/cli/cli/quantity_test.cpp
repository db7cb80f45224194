#include <catch2/catch.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>

#include "support/catoptric_program.h"
#include "support/temporary_folder.h"

using namespace catoptric::test;
using Catch::Contains;
using nlohmann::json;

namespace {

/// The paper's start B with few photons, its light in W or in lm.
std::string scene_text(const std::string& light) {
  return "unit = \"cm\"\nsource.position = [0, 0, 5]\n" + light +
         "\nreflector.points = [[0, 10], [5, 10], [7, 5]]\nreflector.weights = [1, 1.8, 1]\n"
         "near_field.radius = 5\nnear_field.samples = 32\n"
         "[target]\nkind = \"uniform\"\nradius = 5\nirradiance = 2\n"
         "[model]\nphotons = 4000\nkernel_radius = 1\n"
         "[search]\nmost_evaluations = 12\n[variables.w1]\nstep = 0.5\nlower = 0.05\nupper = 20\n";
}

/// Numbers that JSON holds, by their paths; times, version and seconds left out.
void collect(const json& value, const std::string& path, std::map<std::string, double>& numbers) {
  if (value.is_number() && path.find("seconds") == std::string::npos) numbers[path] = value.get<double>();
  if (value.is_structured())
    for (const auto& item : value.items()) collect(item.value(), path + "/" + item.key(), numbers);
}

std::map<std::string, double> numbers_of(const std::filesystem::path& file) {
  std::map<std::string, double> numbers;
  collect(json::parse(read_whole(file)), "", numbers);
  return numbers;
}

}  // namespace

TEST_CASE("a scene in lumens has the numbers of one in watts, and no unit of it is a watt's") {
  const TemporaryFolder folder;
  write_whole(folder / "watts.toml", scene_text("source.power = 0.03"));
  write_whole(folder / "lumens.toml", scene_text("source.flux = 0.03"));
  const std::regex watts("[^A-Za-z]W(/|\\b)");
  for (const char* command : {"simulate", "design", "sensitivity", "explain"}) {
    CAPTURE(command);
    for (const int luminous : {0, 1}) {
      const std::string name = luminous ? "lumens" : "watts";
      const Ended ended =
          program_run(std::string(command) + " '" + (folder / (name + ".toml")).string() + "'" +
                      (std::string(command) == "explain"
                           ? ""
                           : " --out '" + (folder / (std::string(command) + name)).string() + "'"));
      INFO(ended.output);
      CHECK((ended.code == 0 || ended.code == 5));
      CHECK(std::regex_search(ended.output, watts) == (!luminous && std::string(command) != "explain"));
    }
    if (std::string(command) == "explain") continue;
    const auto in_watts = folder / (std::string(command) + "watts"),
               in_lumens = folder / (std::string(command) + "lumens");
    const std::string result = std::string(command) == "sensitivity" ? "sensitivity.json" : "result.json";
    CHECK(numbers_of(in_watts / result) == numbers_of(in_lumens / result));
    for (const auto& entry : std::filesystem::recursive_directory_iterator(in_lumens)) {
      const auto ending = entry.path().extension();
      if (ending != ".csv" && ending != ".json" && ending != ".gp" && ending != ".html") continue;
      CAPTURE(entry.path());
      CHECK_FALSE(
          std::regex_search(read_whole(entry.path()), std::regex("[[]W|W/m|\"W\"|\\(W\\)| W[,.\n<]")));
    }
    CHECK_THAT(read_whole(in_lumens / "report.html"), Contains("lx"));
  }
}

TEST_CASE("a scene is in watts or in lumens, and never in both") {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& light, const std::string& what) {
    write_whole(folder / "scene.toml", scene_text(light));
    const Ended ended = program_run("explain '" + (folder / "scene.toml").string() + "'");
    CHECK(ended.code == 3);
    CHECK_THAT(ended.output, Contains(what));
  };
  refused("source.power = 1\nsource.flux = 1", "stands beside");
  refused("", "source.power");
  refused("source.flux = 1\nvariables.\"source.power\" = {step = 1, lower = 1, upper = 2}", "lm");
  refused("source.power = 1\nvariables.\"source.flux\" = {step = 1, lower = 1, upper = 2}", "W");
}

TEST_CASE("intensity writes what lighting engineers read, and what it writes is a source of the same light") {
  const TemporaryFolder folder;
  write_whole(folder / "lamp.toml",
              scene_text("source.flux = 500\nsource.kind = \"disc\"\nsource.radius = 1"));
  const Ended ended =
      program_run("intensity '" + (folder / "lamp.toml").string() + "' --out '" + (folder / "out").string() +
                  "' --set intensity.luminaire=Spot --set model.photons=200000");
  INFO(ended.output);
  REQUIRE(ended.code == 0);
  CHECK_THAT(ended.output, Contains("beam angle") && Contains("efficiency") && Contains("cd"));
  const json result = parsed(folder / "out" / "intensity.json");
  CHECK(result["flux"]["unit"] == "lm");
  CHECK(result["peak"]["value"] > 100);
  CHECK_THAT(read_whole(folder / "out" / "luminaire.ies"),
             Contains("IES:LM-63-2019") && Contains("Spot") && Contains("1.00010"));
  const std::string bare =
      "reflector.points = [[0, 10], [0.1, 10], [0.2, 9.9]]\nnear_field.radius = 5\nunit = \"cm\"\n";
  for (const char* name : {"luminaire.ies", "luminaire.ldt"}) {
    write_whole(folder / "again.toml",
                bare + "source.kind = \"intensity\"\nsource.axis = [0, 0, -1]\nsource.file = \"" +
                    (folder / "out" / name).string() + "\"\n");
    const Ended again = program_run("intensity '" + (folder / "again.toml").string() + "' --out '" +
                                    (folder / "again").string() + "' --set model.photons=200000");
    INFO(again.output);
    REQUIRE(again.code == 0);
    const json second = parsed(folder / "again" / "intensity.json");
    CHECK(second["flux"]["value"].get<double>() ==
          Catch::Detail::Approx(result["flux"]["value"].get<double>()).epsilon(1e-3));
    CHECK(second["angles"][0]["beam"].get<double>() ==
          Catch::Detail::Approx(result["angles"][0]["beam"].get<double>()).epsilon(0.02));
  }
  const Ended fine = program_run("intensity '" + (folder / "lamp.toml").string() + "' --out '" +
                                 (folder / "fine").string() + "' --set intensity.gamma_step=0.25");
  INFO(fine.output);
  CHECK(fine.code == 0);
  CHECK_THAT(fine.output, Contains("no EULUMDAT file"));
  CHECK(std::filesystem::exists(folder / "fine" / "luminaire.ies"));
  CHECK_FALSE(std::filesystem::exists(folder / "fine" / "luminaire.ldt"));
  write_whole(folder / "watts.toml", scene_text("source.power = 5"));
  const Ended radiant = program_run("intensity '" + (folder / "watts.toml").string() + "' --out '" +
                                    (folder / "w").string() + "'");
  CHECK(radiant.code == 0);
  CHECK_FALSE(std::filesystem::exists(folder / "w" / "luminaire.ies"));
  CHECK_THAT(radiant.output, Contains("W/sr"));
}
