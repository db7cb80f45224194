#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "support/catoptric_program.h"
#include "support/temporary_folder.h"

using namespace catoptric::test;
using Catch::Contains;
using nlohmann::json;

TEST_CASE("design writes the whole set of files, and the result says what other programs rely on") {
  const TemporaryFolder folder;
  const std::string out = (folder / "a").string();
  const Ended ended = program_run("design '" + paper + "start_a.toml' --out '" + out + "'" + small);
  INFO(ended.output);
  REQUIRE(ended.code == 0);
  for (const char* name : {"result.json", "reflector.step", "reflector.igs", "reflector.dxf",
                           "irradiance.csv", "convergence.csv", "report.html", "scene.toml"}) {
    INFO(name);
    CHECK(std::filesystem::file_size(folder / "a" / name) > 100);
  }
  const json result = parsed(folder / "a" / "result.json");
  CHECK(result["outcome"] == "converged");
  CHECK(result["variables"]["w1"].is_number());
  CHECK(result["variables"]["r2"].is_number());
  for (const char* key : {"metric", "value", "unit", "kernel_radius", "noise", "bias"}) {
    INFO(key);
    CHECK(result["objective"].contains(key));
    CHECK(result["start"]["objective"].contains(key));
  }
  CHECK(result["start"]["variables"]["w1"] == 1.6);
  CHECK(result["objective"]["value"] < result["start"]["objective"]["value"]);
  for (const char* key : {"iterations", "successes", "evaluations", "photons"})
    CHECK(result["counts"][key].is_number_unsigned());
  for (const char* key : {"seconds", "model", "intersector", "seed", "version"}) CHECK(result.contains(key));
  CHECK_THAT(read_whole(folder / "a" / "irradiance.csv"),
             Catch::StartsWith("x,y,z,target,direct,reflected,total,noise\n"));
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path()))
    CHECK(entry.path().string().find(".partial") == std::string::npos);
}

TEST_CASE("the written scene gives the same result bit for bit, and threads change nothing", "[long]") {
  const TemporaryFolder folder;
  const auto run = [&](const std::string& scene, const std::string& name, const std::string& more) {
    const Ended ended =
        program_run("design '" + scene + "' --quiet --out '" + (folder / name).string() + "' " + more);
    INFO(ended.output);
    REQUIRE(ended.code == 0);
    CHECK(ended.output.empty());
  };
  run(paper + "start_a.toml", "one", "--threads 1" + small);
  run(paper + "start_a.toml", "two", "--threads 2" + small);
  run(paper + "start_a.toml", "seven", "--threads 7" + small);
  run((folder / "one" / "scene.toml").string(), "again", "");
  run(paper + "start_a.toml", "other", "--seed 2" + small);
  for (const char* name : {"two", "seven", "again"}) {
    INFO(name);
    CHECK(repeatable(folder / name / "result.json") == repeatable(folder / "one" / "result.json"));
    for (const char* file : {"irradiance.csv", "convergence.csv", "reflector.step", "reflector.igs"}) {
      INFO(file);
      CHECK(read_whole(folder / name / file) == read_whole(folder / "one" / file));
    }
  }
  CHECK(read_whole(folder / "other" / "irradiance.csv") != read_whole(folder / "one" / "irradiance.csv"));
}

TEST_CASE("a search that runs out of evaluations ends with 5 and writes its files") {
  const TemporaryFolder folder;
  const Ended ended =
      program_run("design '" + paper + "start_a.toml' --set search.most_evaluations=4 --out '" +
                  (folder / "a").string() + "'" + small);
  CHECK(ended.code == 5);
  CHECK(parsed(folder / "a" / "result.json")["outcome"] == "unconverged");
  CHECK(std::filesystem::exists(folder / "a" / "reflector.step"));
}

TEST_CASE("every search can be asked for by name, keeps to its budget and betters the start", "[long]") {
  for (const char* method :
       {"hooke-jeeves", "levenberg-marquardt", "nelder-mead", "compass", "cma-es", "differential-evolution",
        "self-adaptive-de", "particle-swarm", "simulated-annealing", "genetic"})
    for (const char* more : {"", " --set search.restarts=2", " --set 'search.kernels=[3, 1]'"}) {
      // Restarts and kernels go around any method: one that draws stands for all.
      if (*more != 0 && std::string_view(method) != "cma-es") continue;
      INFO(method << more);
      const TemporaryFolder folder;
      const Ended ended = program_run("design '" + paper + "start_a.toml' --quiet --out '" +
                                      (folder.path() / "run").string() + "'" + small +
                                      " --set model.interactions=4 --set search.most_evaluations=40" +
                                      " --set search.method=" + method + more);
      INFO(ended.output);
      CHECK((ended.code == 0 || ended.code == 5));
      const json result = parsed(folder.path() / "run" / "result.json");
      CHECK(result.at("counts").at("evaluations") <= 40);
      CHECK(result.at("search_value") < 0.7);  // the start has 1.64
    }
}

TEST_CASE("a search by a wrong name, or one that does not fit the scene, is refused with what to do") {
  const Ended wrong = program_run("design '" + paper + "start_a.toml' --set search.method=cmaes");
  CHECK(wrong.code == 3);
  CHECK_THAT(wrong.output, Contains("did you mean \"cma-es\"?"));
  const Ended unfit = program_run(
      "design '" + paper + "start_a.toml' --set search.method=levenberg-marquardt --set model.rung=rings");
  CHECK(unfit.code == 3);
  CHECK_THAT(unfit.output, Contains("ray tubes") && Contains("rings"));
}

TEST_CASE("a value that is reached ends a search, and that is a good end") {
  const TemporaryFolder folder;
  const Ended ended = program_run(
      "design '" + paper + "start_c.toml' --quiet --out '" + (folder.path() / "run").string() + "'" + small +
      " --set model.interactions=4 --set search.restarts=1000 --set search.reach=0.01");
  INFO(ended.output);
  CHECK(ended.code == 0);
  const json result = parsed(folder.path() / "run" / "result.json");
  CHECK(result.at("search_value") <= 0.01);
  CHECK(result.at("outcome") == "converged");
  CHECK(result.at("counts").at("restarts") > 0);  // from C itself it is not to be had
}

TEST_CASE(
    "a constraint that cannot be met is named with by how much, and a start that breaks one is led in") {
  const TemporaryFolder folder;
  const auto design = [&](const std::string& constraint, const std::string& out) {
    return program_run("design '" + paper + "start_a.toml' --set " + constraint + " --out '" +
                       (folder / out).string() + "'" + small);
  };
  // the apex at 10 cm and the rim at 5 cm do not move: no mirror of these variables is lower than 5 cm
  const Ended broken = design("constraints.height_max=4.5", "broken");
  CHECK(broken.code == 5);
  CHECK_THAT(broken.output, Contains("height_max is 5 cm, at most 4.5 is allowed (0.5 cm too much)"));
  const json no = parsed(folder / "broken" / "result.json");
  CHECK(no["outcome"] == "unsatisfied");
  CHECK(no["search_value"].is_null());
  CHECK(no["constraints"][0]["name"] == "height_max");
  CHECK(no["constraints"][0]["met"] == false);
  CHECK(no["constraints"][0]["violation"].get<double>() == Approx(0.5));
  // the start's rim is at 9 cm; the search must come in and then stay in, although (1, 10) fits better
  const Ended kept = design("constraints.rim_radius_max=8.5", "kept");
  CHECK(kept.code == 0);
  CHECK_THAT(kept.output, Contains("All constraints are met."));
  const json yes = parsed(folder / "kept" / "result.json");
  CHECK(yes["variables"]["r2"].get<double>() <= 8.5);
  CHECK(yes["constraints"][0]["met"] == true);
  CHECK(yes["start"]["constraints"][0]["met"] == false);
  CHECK(yes["start"]["constraints"][0]["violation"].get<double>() == Approx(0.5));
  CHECK_THAT(read_whole(folder / "kept" / "report.html"),
             Contains("rim_radius_max") && Contains("The search converged. With the mirror found"));
  CHECK_THAT(read_whole(folder / "broken" / "report.html"),
             Contains("The constraints are broken: this mirror is not what was asked for.") &&
                 Contains("height_max is 5 cm, at most 4.5 is allowed"));
  // the rank of the start, which breaks the constraint, is no figure to be shown
  CHECK_THAT(read_whole(folder / "kept" / "convergence.csv"), Contains("\n0,0,1,1,start,,1.6,9\n"));
  for (const char* out : {"kept", "broken"})
    for (const char* file : {"convergence.csv", "report.html", "result.json"}) {
      INFO(out << "/" << file);
      CHECK_THAT(read_whole(folder / out / file), !Contains("e+100"));
    }
}

TEST_CASE("every metric is reported whatever is searched") {
  const TemporaryFolder folder;
  for (const std::string metric : {"rmse", "uniformity", "enclosed-flux"}) {
    const Ended ended = program_run("design '" + paper + "start_a.toml' --set search.metric=" + metric +
                                    " --out '" + (folder / metric).string() + "'" + small);
    INFO(ended.output);
    CHECK(ended.code == 0);
    const json result = parsed(folder / metric / "result.json");
    CHECK(result["objective"]["metric"] == metric);
    for (const char* name : {"rmse", "relative-rmse", "enclosed-flux", "uniformity", "efficiency"})
      for (const json& judged : {result, result["start"]}) CHECK(judged["metrics"][name]["noise"] >= 0);
    const double value = result["metrics"][metric]["value"], searched = result["objective"]["value"];
    CHECK(searched == Approx(metric == "rmse" ? value : 1 - value));
    CHECK(searched <= result["start"]["objective"]["value"].get<double>());
    CHECK_THAT(ended.output, Contains("efficiency"));
  }
}

TEST_CASE("an interrupted search ends with 130 and leaves its best so far") {
  const TemporaryFolder folder;
  // --foreground: else timeout signals its group too, and a second signal ends the program at once
  const Ended ended = run_shell(
      "timeout --foreground --signal=INT --preserve-status 2 '" + program + "' design '" + paper +
      "start_a.toml' --set model.rung=photons --set model.photons=10000000 --set model.replicates=2 --out '" +
      (folder / "a").string() + "'");
  INFO(ended.output);
  CHECK(ended.code == 130);
  CHECK(parsed(folder / "a" / "result.json")["outcome"] == "interrupted");
  CHECK(std::filesystem::exists(folder / "a" / "reflector.step"));
}

TEST_CASE("a free profile is refined as asked, and refinement of anything else is refused") {
  const TemporaryFolder folder;
  const auto design = [&](const std::string& more) {
    return program_run("design '" + paper + "start_a.toml' --quiet --out '" + (folder / "a").string() + "'" +
                       small + " --set 'search.refine=[\"degree 3\"]' " + more);
  };
  const Ended refused = design("");
  CHECK(refused.code == 3);
  CHECK_THAT(refused.output, Contains("search.refine") && Contains("search.free = \"profile\""));
  CHECK_FALSE(std::filesystem::exists(folder / "a"));

  const Ended done =
      design("--set search.free=profile --set search.method=levenberg-marquardt --set start=tailored");
  INFO(done.output);
  REQUIRE((done.code == 0 || done.code == 5));
  const json result = parsed(folder / "a" / "result.json");
  REQUIRE(result["stages"].size() == 2);
  CHECK(result["stages"][0]["variables"] == 5);
  CHECK(result["stages"][1]["step"] == "degree 3");
  CHECK(result["stages"][1]["variables"] == 8);
  CHECK(result["stages"][1]["search_value"].get<double>() <=
        result["stages"][0]["search_value"].get<double>() * 1.01 + 1e-9);  // tubes' own error
  CHECK(result["variables"].size() == 8);
  CHECK(result["start"]["variables"].size() == 5);
}

TEST_CASE("a tailored start, then Levenberg-Marquardt on the whole profile, meets the paper's target") {
  const TemporaryFolder folder;
  const Ended ended =
      program_run("design '" + paper + "start_a.toml' --quiet --out '" + (folder / "a").string() +
                  "' --set start=tailored --set search.free=profile --set "
                  "search.method=levenberg-marquardt");
  INFO(ended.output);
  CHECK(ended.code == 0);
  const json result = parsed(folder / "a" / "result.json");
  CHECK(result["objective"]["value"].get<double>() < 0.004);  // the photons' noise is 0.0032
  CHECK(result["search_value"].get<double>() < 1e-5);
  CHECK(result["variables"].contains("logw1"));
  CHECK_THAT(result["profile_notes"].dump(), Contains("tailored by the diverging ray map"));
}

TEST_CASE("a mirror made from nothing is written, and its scene file gives it again bit for bit", "[long]") {
  const TemporaryFolder folder;
  const auto design = [&](const std::string& scene, const std::string& out, const std::string& more) {
    const Ended ended =
        program_run("design '" + scene + "' --quiet --out '" + (folder / out).string() + "' " + more);
    INFO(ended.output);
    REQUIRE(ended.code == 0);
  };
  const std::string fewer = "--set model.photons=65536 --set near_field.samples=200";
  design(examples + "uniform_disc.toml", "one", fewer);
  design(examples + "uniform_disc.toml", "two", fewer + " --threads 1");
  design((folder / "one" / "scene.toml").string(), "again", "");
  for (const char* name : {"reflector.step", "reflector.igs"}) {
    CHECK(std::filesystem::file_size(folder / "one" / name) > 1000);
    CHECK(read_whole(folder / "one" / name) == read_whole(folder / "again" / name));
  }
  const json one = repeatable(folder / "one" / "result.json");
  json again = repeatable(folder / "again" / "result.json");
  CHECK(one == repeatable(folder / "two" / "result.json"));
  CHECK(one["variables"].is_object());
  CHECK_THAT(one["profile_notes"].dump(), Contains("rays miss their places by"));
  CHECK(one["objective"]["value"].get<double>() < 0.01);
  CHECK(one["constraints"].size() == 2);
  for (const json& constraint : one["constraints"]) CHECK(constraint["met"] == true);
  CHECK(again["profile_notes"].empty());  // the mirror is written out by then
  again["profile_notes"] = one["profile_notes"];
  CHECK(one == again);
}

TEST_CASE("what a tailored mirror cannot reach is named by its key before any search") {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& change, const std::string& key, const std::string& words) {
    const Ended ended = program_run("design '" + examples + "uniform_disc.toml' --out '" +
                                    (folder / "out").string() + "' " + change);
    INFO(change << "\n-> " << ended.output);
    CHECK(ended.code == 3);
    CHECK_THAT(ended.output, Contains(" " + key + ": ") && Contains(words));
    CHECK_FALSE(std::filesystem::exists(folder / "out"));
  };
  refused("--set target.irradiance=0.5", "target.kind", "no mirror takes light away");
  // 10 W / (4 pi) / 1 m^2 straight below the source
  refused("--set target.irradiance=0.5", "target.kind", "up to 0.29");
  refused("--set source.power=3", "source.power", "can have 3 W at most");
  refused("--set 'near_field.normal=[0, 0, -1]'", "near_field.normal", "looks away");
  refused("--set 'source.position=[5, 0, 0]'", "source.position", "on the axis");
  refused("--set 'source.axis=[0, 1, 0]' --set source.exponent=1", "source.axis", "alike round the axis");
  refused("--set reflector.reflectance=0", "reflector.reflectance", "reflects nothing");
  refused("--set reflector.degree=2", "reflector.degree", "stands alone");
  refused("--set tailored.points=3", "tailored.points", "too few for degree 3");

  std::string text = read_whole(examples + "uniform_disc.toml");
  const auto begin = text.find("[constraints]"), end = text.find("[near_field]");
  REQUIRE(begin < end);
  text.erase(begin, end - begin);
  write_whole(folder / "no_size.toml", text);
  const Ended ended = program_run("design '" + (folder / "no_size.toml").string() + "'");
  CHECK(ended.code == 3);
  CHECK_THAT(ended.output, Contains("tailored.vertex: is missing") && Contains("constraints.height_max"));
}

TEST_CASE("an intensity wanted from afar is searched and reported, and only where it is given") {
  const TemporaryFolder folder;
  write_whole(folder / "wanted.csv", "angle,intensity\n0,0.006\n40,0.004\n60,0.0025\n");
  const auto design = [&](const std::string& out, const std::string& more) {
    return program_run("design '" + paper + "start_a.toml' --quiet --out '" + (folder / out).string() + "'" +
                       small + " --set model.interactions=4 --set search.metric=intensity-rmse " + more);
  };
  const std::string file = "--set \"target.intensity_file='" + (folder / "wanted.csv").string() + "'\"";
  const Ended missing = design("missing", "");
  CHECK(missing.code == 3);
  CHECK_THAT(missing.output, Contains("search.metric") && Contains("target.intensity_file"));
  const Ended fit = design("fit", file + " --set search.method=levenberg-marquardt");
  CHECK(fit.code == 3);
  CHECK_THAT(fit.output, Contains("rmse or relative-rmse"));

  const Ended done = design("done", file);
  INFO(done.output);
  REQUIRE(done.code == 0);
  const json result = parsed(folder / "done" / "result.json");
  CHECK(result["objective"]["unit"] == "W/sr");
  const json &best = result["metrics"]["intensity-rmse"],
             &start = result["start"]["metrics"]["intensity-rmse"];
  CHECK(result["objective"]["value"] == best["value"]);
  CHECK(best["noise"].get<double>() > 0);
  CHECK(best["value"].get<double>() < start["value"].get<double>());
  CHECK(result["metrics"].contains("rmse"));

  const Ended again = program_run("design '" + (folder / "done" / "scene.toml").string() +
                                  "' --quiet --threads 1 --out '" + (folder / "again").string() + "'");
  REQUIRE(again.code == 0);
  CHECK(repeatable(folder / "again" / "result.json") == repeatable(folder / "done" / "result.json"));
}
