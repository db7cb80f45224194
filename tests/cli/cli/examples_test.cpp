#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "support/catoptric_program.h"
#include "support/temporary_folder.h"

/// The examples that go from lamp to files: each run with few photons, every promised file and constraint
/// looked at. What they reach with all photons is in the README.

using namespace catoptric::test;
using Catch::Contains;
using nlohmann::json;

namespace {

/// Runs a design and checks its files and constraints.
/// @in few: settings that make it fast, and still better than its start
json designed(const std::string& scene, const std::string& few, const std::filesystem::path& out) {
  const Ended ended = program_run("design '" + examples + scene + "' --out '" + out.string() + "' " + few);
  INFO(ended.output);
  REQUIRE((ended.code == 0 || ended.code == 5));  // few evaluations may end the search early
  for (const char* name :
       {"reflector.step", "reflector.igs", "designed.toml", "scene.toml", "report.html", "irradiance.csv"}) {
    CAPTURE(name);
    CHECK(std::filesystem::file_size(out / name) > 500);
  }
  CHECK_THAT(read_whole(out / "reflector.step"), Contains("SURFACE_OF_REVOLUTION"));
  json result = parsed(out / "result.json");
  CHECK(result["constraints"].size() >= 3);
  for (const json& constraint : result["constraints"]) {
    CAPTURE(constraint.dump());
    CHECK(constraint["met"] == true);
  }
  // What photon noise adds to a verdict by few photons is known, and taken off.
  const auto without_bias = [](const json& figure) {
    return figure["value"].get<double>() - figure["bias"].get<double>();
  };
  CHECK(without_bias(result["objective"]) < 0.8 * without_bias(result["start"]["objective"]));
  return result;
}

/// The photometric files of the lamp that a design found.
json luminaire_of(const std::filesystem::path& out, const std::string& more) {
  const std::filesystem::path folder = out / "luminaire";
  const Ended ended = program_run("intensity '" + (out / "designed.toml").string() + "' --out '" +
                                  folder.string() + "' " + more);
  INFO(ended.output);
  REQUIRE(ended.code == 0);
  CHECK_THAT(read_whole(folder / "luminaire.ies"), Catch::StartsWith("IES:LM-63-2019"));
  CHECK(std::filesystem::file_size(folder / "luminaire.ldt") > 500);
  return parsed(folder / "intensity.json");
}

double limit_of(const json& result, const std::string& name) {
  for (const json& constraint : result["constraints"])
    if (constraint["name"] == name) return constraint["value"];
  FAIL("no constraint " << name);
  return 0;
}

}  // namespace

TEST_CASE("the downlight is designed beside its COB within its package, and has an IES file") {
  const TemporaryFolder folder;
  const json result =
      designed("led_downlight.toml",
               "--set model.photons=2048 --set model.replicates=2 --set near_field.samples=64 "
               "--set search.most_evaluations=120",
               folder / "a");
  CHECK(limit_of(result, "opening_min") >= 5);
  CHECK(result["metrics"]["efficiency"]["value"] > 0.45);
  const json luminaire = luminaire_of(folder / "a", "--set model.photons=20000 --set model.replicates=2");
  // Some 92 % leave: half of the light meets the mirror, which keeps a tenth of it.
  CHECK(luminaire["efficiency"] > 0.9);
  CHECK(luminaire["efficiency"] < 0.96);
  CHECK(luminaire["zones"][0]["flux"]["value"] > 600);
}

TEST_CASE("the spot lamp's beam widens from the paraboloid's towards ten degrees", "[long]") {
  const TemporaryFolder folder;
  designed("narrow_spot.toml",
           "--set model.photons=8192 --set model.replicates=2 --set near_field.samples=100 "
           "--set search.most_evaluations=150",
           folder / "a");
  const json luminaire =
      luminaire_of(folder / "a", "--set model.photons=50000 --set intensity.gamma_step=0.5");
  CHECK(luminaire["angles"][0]["beam"] > 9);
  CHECK(luminaire["angles"][0]["beam"] < 11);
  CHECK(luminaire["peak"]["value"] > 9000);
}

TEST_CASE("the torch is designed from a ray file that the scene of its LED makes first") {
  const TemporaryFolder folder;
  const Ended led = program_run("rays '" + examples + "torch_led.toml' --set rays.count=100000 --out '" +
                                (folder / "led").string() + "'");
  INFO(led.output);
  REQUIRE(led.code == 0);
  CHECK_THAT(read_whole(folder / "led" / "source.toml"), Contains("flux = 300\n"));
  CHECK(parsed(folder / "led" / "rays.json")["file_flux"]["value"].get<double>() ==
        Catch::Detail::Approx(300).epsilon(1e-7));
  const std::string file = "--set source.file='" + (folder / "led" / "source.tm25ray").string() + "' ";
  const json result = designed("torch.toml",
                               file +
                                   "--set model.photons=8192 --set model.replicates=2 "
                                   "--set near_field.samples=64 --set search.most_evaluations=60",
                               folder / "a");
  CHECK(limit_of(result, "rim_radius_max") <= 20);
  const json luminaire = luminaire_of(folder / "a", "--set model.photons=20000 --set intensity.gamma_step=1");
  CHECK(luminaire["source_flux"]["value"] == 300);
  CHECK(luminaire["peak"]["value"] > 3000);
}

TEST_CASE("a mirror behind a cover has the cover in its light, from near and from afar") {
  const TemporaryFolder folder;
  const std::string few = "--set model.photons=30000 --set model.replicates=2 --set near_field.samples=100";
  const Ended ended =
      program_run("design '" + examples + "cover_glass.toml' --out '" + (folder / "a").string() + "' " + few);
  INFO(ended.output);
  REQUIRE(ended.code == 0);
  CHECK_THAT(ended.output, Contains("stood alone"));
  CHECK(std::filesystem::file_size(folder / "a" / "reflector.step") > 500);
  const json result = parsed(folder / "a" / "result.json");
  CHECK(limit_of(result, "rim_radius_max") <= 60);
  // About 8 % are thrown back, and some of that comes down by way of the mirror.
  const double efficiency = result["metrics"]["efficiency"]["value"];
  CHECK(efficiency > 0.65);
  CHECK(efficiency < 0.75);
  CHECK(result["energy"]["stopped_by_objects"] > 0);
  const json luminaire = luminaire_of(folder / "a", "--set model.photons=20000 --set model.replicates=2");
  CHECK(luminaire["efficiency"] > 0.97);  // what a pane throws back leaves upwards past the mirror's rim
  CHECK(luminaire["efficiency"] < 1);
}

TEST_CASE("a low bay lights floor, walls and ceiling, and its photometric file is the luminaire's alone") {
  const TemporaryFolder folder;
  const std::string few = "--set model.photons=30000 --set model.replicates=2 --set near_field.samples=100";
  const Ended ended =
      program_run("design '" + examples + "low_bay.toml' --out '" + (folder / "a").string() + "' " + few);
  INFO(ended.output);
  REQUIRE(ended.code == 0);
  CHECK_THAT(ended.output, Contains("wall_east") && Contains("ceiling"));
  const json result = parsed(folder / "a" / "result.json");
  const json further = result["near_field"]["further"];
  REQUIRE(further.size() == 5);
  // The room is symmetric, and so are its walls' light.
  const double east = further["wall_east"]["average"]["value"],
               north = further["wall_north"]["average"]["value"];
  CHECK(east > 20);
  CHECK(north == Catch::Detail::Approx(east).epsilon(0.1));
  // A closed room: all light ends on a surface.
  CHECK(result["energy"]["escaped"] == 0);
  CHECK_THAT(read_whole(folder / "a" / "irradiance.csv"),
             Contains(",noise,surface") && Contains(",wall_south"));
  const json luminaire = luminaire_of(folder / "a", "--set model.photons=20000 --set model.replicates=2");
  CHECK(luminaire["efficiency"] == Catch::Detail::Approx(1).epsilon(1e-6));  // a perfect mirror, no room
}

TEST_CASE("what a design found is a scene of its own, light and figures the same") {
  const TemporaryFolder folder;
  // A height, a power and a reflectance are found beside the mirror's shape.
  const std::string few = " --set model.photons=4000 --set near_field.samples=60";
  REQUIRE(
      program_run("design '" + examples + "find_source.toml' --out '" + (folder / "a").string() + "'" + few)
          .code == 0);
  const Ended again = program_run("simulate '" + (folder / "a" / "designed.toml").string() + "' --out '" +
                                  (folder / "b").string() + "'");
  INFO(again.output);
  REQUIRE(again.code == 0);
  const json found = parsed(folder / "a" / "result.json"), same = parsed(folder / "b" / "result.json");
  CHECK(same["energy"]["source"] == found["energy"]["source"]);
  CHECK(same["reflector"] == found["reflector"]);
  const std::string scene = read_whole(folder / "a" / "designed.toml");
  CHECK_THAT(scene, !Contains("[variables") && Contains("kind = \"none\"") && Contains("method = \"none\""));
  const double power = found["variables"]["source.power"],
               reflectance = found["variables"]["reflector.reflectance"];
  CHECK(reflectance == Catch::Detail::Approx(0.8).epsilon(0.01));
  CHECK_THAT(scene, Contains("reflectance = " + json(reflectance).dump()) &&
                        Contains("power = " + json(power).dump()));
}
