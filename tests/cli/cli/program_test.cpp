#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "support/catoptric_program.h"
#include "support/temporary_folder.h"

using namespace catoptric::test;
using Catch::Contains;
using nlohmann::json;

TEST_CASE("help and version are no errors, and every command shows an example") {
  CHECK(program_run("--help").code == 0);
  CHECK(program_run("--version").code == 0);
  const Ended keys = program_run("--keys");
  CHECK(keys.code == 0);
  CHECK_THAT(keys.output, Contains("model.photons\n") && Contains("100000 when left out"));
  for (const char* command : {"design", "simulate", "explain", "landscape", "profile", "export", "tradeoff",
                              "sensitivity", "intensity", "study"}) {
    const Ended help = program_run(std::string(command) + " --help");
    INFO(help.output);
    CHECK(help.code == 0);
    CHECK_THAT(help.output, Contains("Example: catoptric " + std::string(command)));
  }
}

TEST_CASE("a wrong command line ends with 2") {
  for (const char* arguments :
       {"", "desing", "design", "design a.toml --no-such-option", "design a.toml --threads x"}) {
    INFO(arguments);
    CHECK(program_run(arguments).code == 2);
  }
  const Ended ended = program_run("design '" + paper + "start_a.toml' --set photons");
  CHECK(ended.code == 2);
  CHECK_THAT(ended.output, Contains("key=value"));
}

TEST_CASE("a broken scene ends with 3, names file, line and key, and leaves no folder") {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& text, const std::string& part) {
    write_whole(folder / "scene.toml", text);
    const Ended ended = program_run("simulate '" + (folder / "scene.toml").string() + "' --out '" +
                                    (folder / "out").string() + "'");
    INFO(text << "\n-> " << ended.output);
    CHECK(ended.code == 3);
    CHECK_THAT(ended.output, Contains(part));
    CHECK_FALSE(std::filesystem::exists(folder / "out"));
  };
  refused("seed = \n", "scene.toml:1");
  refused("\n[modle]\nphotons = 3\n", "scene.toml:3");
  refused("[source]\npower = -1\n", "source.power");
  refused("[source]\npower = 1\n", "reflector.points");
  refused(std::string(200000, '['), "not valid TOML");
  refused(std::string("title = \"\xff\xfe\"\n"), "not valid TOML");
  CHECK(program_run("simulate /nonexistent.toml").code == 3);
  CHECK(program_run("simulate '" + folder.path().string() + "'").code == 3);
}

TEST_CASE("a folder that cannot be written is found before the work starts") {
  const Ended ended =
      program_run("design '" + paper + "start_a.toml' --set model.photons=100000000 --out /dev/null/out");
  CHECK(ended.code == 6);
  CHECK_THAT(ended.output, Contains("/dev/null/out"));
}

TEST_CASE("simulate, landscape, export and study leave what they promise") {
  const TemporaryFolder folder;
  const auto run = [&](const std::string& arguments, const std::string& name) {
    const Ended ended = program_run(arguments + " --out '" + (folder / name).string() + "'");
    INFO(arguments << "\n" << ended.output);
    REQUIRE(ended.code == 0);
    return ended.output;
  };
  run("simulate '" + paper + "paraboloid.toml'" + small, "s");
  CHECK(parsed(folder / "s" / "result.json")["objective"]["value"].is_number());
  CHECK(std::filesystem::exists(folder / "s" / "irradiance.csv"));

  run("landscape '" + paper + "start_a.toml' --set landscape.steps=[3,4]" + small, "l");
  const std::string table = read_whole(folder / "l" / "landscape.csv");
  CHECK(std::count(table.begin(), table.end(), '\n') == 13);
  CHECK_FALSE(std::filesystem::exists(folder / "l" / "paths.csv"));
  const std::string ways =
      run("landscape '" + paper +
              "start_a.toml' --set landscape.steps=[3,4] --set landscape.paths=true --set "
              "'landscape.starts=[[1.8,7]]'" +
              small,
          "p");
  CHECK_THAT(ways, Contains("A: (1.6, 9) to (") && Contains("B: (1.8, 7) to ("));
  CHECK_THAT(read_whole(folder / "p" / "paths.csv"), Contains("\nA,1.6,9,") && Contains("\nB,1.8,7,"));
  CHECK_THAT(read_whole(folder / "p" / "figures" / "contours.gp"), Contains("'A: (1.6, 9) to ("));

  run("export '" + paper +
          "paraboloid.toml' --format step --format stl --format glb --format brep --format iges "
          "--format dxf",
      "e");
  for (const char* name : {"reflector.step", "reflector.igs", "reflector.stl", "reflector.glb",
                           "reflector.brep", "reflector.dxf"})
    CHECK(std::filesystem::exists(folder / "e" / name));

  write_whole(folder / "study.toml",
              "scene = '" + paper +
                  "start_a.toml'\ncommand = \"simulate\"\n[[runs]]\nname = \"a\"\nset = "
                  "{\"variables.w1.start\" = 1.0}\nreference = {w1 = 1.5}\n[[runs]]\nname = \"b\"\n");
  const std::string printed = run("study '" + (folder / "study.toml").string() + "'" + small, "st");
  const json list = parsed(folder / "st" / "study.json");
  REQUIRE(list.size() == 2);
  CHECK(list[0]["variables"]["w1"] == 1.0);
  CHECK(list[0]["reference"]["w1"] == 1.5);
  CHECK(list[1]["variables"]["w1"] == 1.6);
  CHECK_THAT(printed, Contains("w1 ref"));
  CHECK(std::filesystem::exists(folder / "st" / "b" / "irradiance.csv"));
}

TEST_CASE("explain says what is modelled and why, and a rung that is not valid is refused with its reason") {
  const Ended plan = program_run("explain '" + paper + "start_a.toml' --set model.rung=auto");
  CHECK(plan.code == 0);
  CHECK_THAT(plan.output, Contains("rung") && Contains("tubes") && Contains("verdict"));
  const Ended refused = program_run(
      "explain '" + paper +
      "start_a.toml' --set model.rung=tubes --set source.position=[1,0,5] --set target.kind=none");
  CHECK(refused.code == 3);
  CHECK_THAT(refused.output, Contains("model.rung") && Contains("axis"));
}

TEST_CASE("an irradiance.csv serves as the target of another scene") {
  const TemporaryFolder folder;
  REQUIRE(
      program_run("simulate '" + paper + "paraboloid.toml' --out '" + (folder / "p").string() + "'" + small)
          .code == 0);
  std::string scene = read_whole(paper + "start_a.toml");
  const auto at = scene.find("kind = \"paraboloid\"\nfocal_length = 5");
  REQUIRE(at != std::string::npos);
  scene.replace(at, std::string("kind = \"paraboloid\"\nfocal_length = 5").size(),
                "kind = \"csv\"\nfile = \"p/irradiance.csv\"\ncolumn = \"total\"");
  write_whole(folder / "scene.toml", scene);
  const Ended ended =
      program_run("simulate '" + (folder / "scene.toml").string() +
                  "' --set variables.w1.start=1 --set variables.r2.start=10 --out '" +
                  (folder / "q").string() + "' --set model.replicates=2 --set model.photons=4000");
  INFO(ended.output);
  REQUIRE(ended.code == 0);
  CHECK(parsed(folder / "q" / "result.json")["objective"]["value"] < 0.2);
  write_whole(folder / "scene.toml", scene.replace(scene.find("column = \"total\""), 16, "column = \"lux\""));
  CHECK_THAT(program_run("simulate '" + (folder / "scene.toml").string() + "'").output,
             Contains("its columns are x, y, z, target"));
}

TEST_CASE("a profile file that is none ends with 4") {
  const TemporaryFolder folder;
  write_whole(folder / "not.igs", "this is no IGES file\n");
  for (const std::string& name :
       {(folder / "not.igs").string(), std::string("/nonexistent.igs"), folder.path().string()}) {
    const Ended ended = program_run("profile '" + name + "'");
    INFO(ended.output);
    CHECK(ended.code == 4);
  }
}

TEST_CASE("simulate takes any rung that is valid, and all of them see the same light") {
  const TemporaryFolder folder;
  json results;
  for (const char* rung : {"tubes", "rings", "photons"}) {
    const Ended ended = program_run(
        "simulate '" + paper + "start_a.toml' --quiet --set model.photons=20000 --set model.rung=" + rung +
        " --out '" + (folder / rung).string() + "'");
    INFO(ended.output);
    REQUIRE(ended.code == 0);
    results[rung] = parsed(folder / rung / "result.json");
    CHECK(results[rung]["model"] == rung);
  }
  CHECK(results["tubes"]["objective"]["noise"] == 0.0);
  CHECK(results["tubes"]["counts"]["photons"] == 0);
  // All smooth with the same kernel: noise of 160 000 photons is a hundredth of start A's distance.
  const double exact = results["tubes"]["objective"]["value"];
  for (const char* rung : {"rings", "photons"})
    CHECK(results[rung]["objective"]["value"].get<double>() == Approx(exact).epsilon(0.02));
}

TEST_CASE("an accuracy is proven, or the program says how far it got and ends with 5") {
  const TemporaryFolder folder;
  const auto simulate = [&](const std::string& more) {
    return program_run("simulate '" + paper + "paraboloid.toml' --out '" + (folder / "a").string() + "' " +
                       more);
  };
  const auto error_to_target = [&] {
    double square = 0, target_square = 0;
    std::istringstream lines(read_whole(folder / "a" / "irradiance.csv"));
    std::string line;
    std::getline(lines, line);
    while (std::getline(lines, line)) {
      std::vector<double> v;
      std::istringstream cells(line);
      for (std::string cell; std::getline(cells, cell, ',');) v.push_back(std::stod(cell));
      square += (v[6] - v[3]) * (v[6] - v[3]);
      target_square += v[3] * v[3];
    }
    return std::sqrt(square / target_square);
  };
  for (const char* rung : {"auto", "rings", "photons"}) {
    INFO(rung);
    const Ended ended = simulate(std::string("--set accuracy=0.003 --set model.rung=") + rung);
    CHECK(ended.code == 0);
    CHECK_THAT(ended.output, Contains("proven"));
    const json result = parsed(folder / "a" / "result.json");
    CHECK(result["accuracy"]["proven"] == true);
    CHECK(result["accuracy"]["error95"].get<double>() <= 0.003);
    CHECK(error_to_target() <= 0.003);
  }
  const Ended short_of_it =
      simulate("--set accuracy=1e-7 --set model.rung=photons --set model.most_photons=20000");
  CHECK(short_of_it.code == 5);
  CHECK_THAT(short_of_it.output, Contains("not proven"));
  CHECK(parsed(folder / "a" / "result.json")["accuracy"]["proven"] == false);
  const Ended tilted = simulate(
      "--set near_field.normal=[0,0.6,0.8] --set target.kind=none --set model.rung=tubes --set accuracy=0.1");
  CHECK(tilted.code == 3);
  CHECK_THAT(tilted.output, Contains("tilted"));
}

TEST_CASE("tradeoff measures, chooses and writes", "[long]") {
  const TemporaryFolder folder;
  const Ended ended =
      program_run("tradeoff '" + paper +
                  "paraboloid.toml' --set tradeoff.most_photons=10000 --set tradeoff.seconds=0.2 --out '" +
                  folder.path().string() + "'");
  INFO(ended.output);
  REQUIRE(ended.code == 0);
  CHECK_THAT(ended.output, Contains("Take for 10 %") && Contains("closed form"));
  const json trade = parsed(folder / "tradeoff.json");
  CHECK(trade["choices"].size() == 3);
  for (const json& choice : trade["choices"])
    CHECK(choice["setting"]["error_greatest"].get<double>() <= choice["accuracy"].get<double>());
  std::set<std::string> rungs;
  for (const json& setting : trade["settings"]) {
    rungs.insert(setting["rung"].get<std::string>());
    CHECK(setting["seconds"].get<double>() > 0);
  }
  CHECK(rungs == std::set<std::string>{"photons", "rings", "tubes"});
  // along the front what costs more is nearer the truth
  double before = HUGE_VAL;
  for (const json& setting : trade["pareto"]) {
    CHECK(setting["error_greatest"].get<double>() < before);
    before = setting["error_greatest"].get<double>();
  }
  CHECK_THAT(read_whole(folder / "tradeoff.csv"), Catch::StartsWith("rung,engine,sampler,photons"));
  CHECK_THAT(read_whole(folder / "report.html"), Contains("<svg"));
}

TEST_CASE("sensitivity prints and writes what the maker must keep") {
  const TemporaryFolder folder;
  const Ended ended = program_run("sensitivity '" + paper + "paraboloid.toml'" + small +
                                  " --set sensitivity.modes=1 --set sensitivity.allowed=0.05 --out '" +
                                  folder.path().string() + "'");
  INFO(ended.output);
  REQUIRE(ended.code == 0);
  CHECK_THAT(ended.output, Contains("source across the axis") && Contains("root sum of squares"));
  const json result = parsed(folder / "sensitivity.json");
  CHECK(result["parameters"].size() == 7);
  for (const json& each : result["parameters"]) {
    CHECK(each["model"] == (each["key"] == "source_lateral" ? "photons" : "tubes"));
    CHECK(each["tolerance_in_budget"].get<double>() ==
          Approx(each["tolerance"].get<double>() / std::sqrt(7.0)));
  }
  CHECK_THAT(read_whole(folder / "sensitivity.csv"),
             Catch::StartsWith("deviation,unit,minus,plus,tolerance"));
  CHECK_THAT(read_whole(folder / "derivatives.csv"), Catch::StartsWith("r,field,source_axial"));
  CHECK_THAT(read_whole(folder / "report.html"), Contains("<svg") && Contains("breaks the symmetry"));
  CHECK(program_run("sensitivity '" + paper + "paraboloid.toml' --set sensitivity.allowed=0").code == 3);
}
