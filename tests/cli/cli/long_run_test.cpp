#include <catch2/catch.hpp>
#include <chrono>
#include <nlohmann/json.hpp>
#include <random>
#include <string>

#include "support/catoptric_program.h"
#include "support/temporary_folder.h"

using namespace catoptric::test;
using Catch::Contains;
using nlohmann::json;

namespace {

/// A search by photons of some seconds.
const std::string slow = "design '" + paper +
                         "start_a.toml' --quiet --set model.rung=photons --set model.photons=60000 --set "
                         "model.replicates=2 --set near_field.samples=60 --set search.smallest_step=0.02";

std::string into(const TemporaryFolder& folder, const std::string& name) {
  return " --out '" + (folder / name).string() + "'";
}

/// Runs the program and ends it by a signal after so many seconds, if it still runs.
/// --foreground: else timeout signals its group too, and a second signal ends the program at once.
Ended ended_by(const std::string& signal, double seconds, const std::string& arguments) {
  return run_shell("timeout --foreground --preserve-status --signal=" + signal + " " +
                   std::to_string(seconds) + " '" + program + "' " + arguments);
}

void check_same_files(const std::filesystem::path& one, const std::filesystem::path& other) {
  CHECK(repeatable(one / "result.json") == repeatable(other / "result.json"));
  for (const char* name :
       {"convergence.csv", "irradiance.csv", "generatrix.csv", "reflector.step", "reflector.igs"}) {
    INFO(name);
    CHECK(read_whole(one / name) == read_whole(other / name));
  }
}

/// No file but those of a finished run, and the temporaries of killed ones.
void check_no_half_file(const std::filesystem::path& folder) {
  if (!std::filesystem::exists(folder)) return;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    INFO(entry.path());
    if (entry.path().extension() == ".json") CHECK_NOTHROW(parsed(entry.path()));
  }
}

/// Kills a search at random moments and resumes it until it ends; it must end as one left alone.
int kill_and_resume(const std::string& command, unsigned seed) {
  const TemporaryFolder folder;
  const Ended whole = program_run(command + into(folder, "whole"));
  REQUIRE((whole.code == 0 || whole.code == 5));
  const long evaluations = parsed(folder / "whole" / "result.json")["counts"]["evaluations"];
  // a search that needs its checkpoint no more takes it away
  CHECK(std::filesystem::exists(folder / "whole" / "checkpoint.json") == (whole.code == 5));

  std::mt19937 random(seed);
  std::uniform_real_distribution<double> share(0, 1);
  int kills = 0;
  std::size_t known = 0;
  const std::filesystem::path checkpoint = folder / "killed" / "checkpoint.json";
  while (true) {
    // ever later, for a verdict and files must come to their end some time, however slow the machine
    const double seconds = 0.1 + share(random) * (0.4 + 0.1 * kills);
    // killed with all its work done: only the end of the process was missing, and the next begins anew
    if (std::filesystem::exists(folder / "killed" / "result.json") && !std::filesystem::exists(checkpoint))
      known = 0;
    const Ended ended = ended_by("KILL", seconds, command + into(folder, "killed") + " --resume");
    INFO(ended.output);
    check_no_half_file(folder / "killed");
    if (ended.code == whole.code) break;
    REQUIRE(ended.code == 128 + 9);
    REQUIRE(++kills < 200);
    if (!std::filesystem::exists(checkpoint)) continue;
    const std::size_t now = parsed(checkpoint)["answers"].size();
    CHECK(now >= known);  // what was known stays known
    known = now;
  }
  CHECK(static_cast<long>(known) <= evaluations);
  check_same_files(folder / "whole", folder / "killed");
  return kills;
}

}  // namespace

TEST_CASE("a search killed at random moments goes on to the bits of one left alone, and loses little") {
  CHECK(kill_and_resume(slow, 7) >= 2);
}

TEST_CASE("a hundred kills of searches of every kind lose nothing but the evaluation in flight", "[.long]") {
  int kills = 0, runs = 0;
  for (unsigned seed = 1; kills < 100; ++seed)
    for (const std::string more :
         {"", " --set search.method=cma-es --set search.most_evaluations=60",
          " --set 'search.kernels=[1.0]' --set search.most_evaluations=60",
          " --set search.method=nelder-mead --set search.restarts=3 --set search.most_evaluations=80"}) {
      kills += kill_and_resume(slow + more, seed);
      ++runs;
      std::printf("%d kills of %d searches survived\n", kills, runs);
    }
}

TEST_CASE("Ctrl-C and SIGTERM leave the best so far, and the search goes on from there to the same bits") {
  const TemporaryFolder folder;
  REQUIRE(program_run(slow + into(folder, "whole")).code == 0);
  for (const std::string signal : {"INT", "TERM"}) {
    const std::string out = (folder / signal).string();
    // sent when the search has something to lose, however slow the machine
    const Ended stopped = run_shell(
        "'" + program + "' " + slow + into(folder, signal) + " & search=$!; " + "while [ ! -e '" + out +
        "/checkpoint.json' ]; do sleep 0.01; done; kill -" + signal + " $search; wait $search");
    INFO(stopped.output);
    REQUIRE(stopped.code == 130);
    const json half = parsed(folder / signal / "result.json");
    CHECK(half["outcome"] == "interrupted");
    CHECK(half["objective"]["value"] <= half["start"]["objective"]["value"]);
    CHECK(std::filesystem::exists(folder / signal / "reflector.step"));
    CHECK(std::filesystem::exists(folder / signal / "report.html"));
    const Ended resumed = program_run(slow + into(folder, signal) + " --resume");
    INFO(resumed.output);
    CHECK(resumed.code == 0);
    check_same_files(folder / "whole", folder / signal);
  }
}

TEST_CASE("photons in flight are given up when the user stops, be they a thousand million", "[long]") {
  const TemporaryFolder folder;
  const auto begin = std::chrono::steady_clock::now();
  const Ended stopped = ended_by("INT", 1.0,
                                 "design '" + paper +
                                     "start_a.toml' --quiet --set model.rung=photons --set "
                                     "near_field.samples=60 --set model.photons=1000000000" +
                                     into(folder, "a"));
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  INFO(stopped.output);
  CHECK(stopped.code == 130);
  CHECK(seconds < 60);  // here 3; the evaluation alone would take some 100, the verdict 16 of them
  const json result = parsed(folder / "a" / "result.json");
  CHECK(result["outcome"] == "interrupted");
  CHECK(result["search_value"].is_null());  // the first evaluation was not finished
  CHECK(result["objective"]["noise"] > 0);
  // the same in the verdict, when the search is over
  const Ended judged = ended_by("INT", 1.0,
                                "design '" + paper +
                                    "start_a.toml' --quiet --set search.method=none --set "
                                    "model.photons=1000000000" +
                                    into(folder, "c"));
  INFO(judged.output);
  CHECK(judged.code == 130);
  CHECK(parsed(folder / "c" / "result.json")["objective"]["noise"] > 0);
  const Ended simulated = ended_by("INT", 1.0,
                                   "simulate '" + paper +
                                       "start_a.toml' --quiet --set model.rung=photons --set "
                                       "model.photons=1000000000" +
                                       into(folder, "b"));
  CHECK(simulated.code == 130);
  CHECK_THAT(simulated.output, Contains("interrupted: nothing was written"));
}

TEST_CASE("every way to search can be broken off and resumed with a larger budget", "[long]") {
  for (const std::string more :
       {"--set search.method=hooke-jeeves", "--set search.method=nelder-mead --set search.restarts=5",
        "--set search.method=cma-es", "--set search.method=levenberg-marquardt",
        "--set 'search.kernels=[2.0, 1.0]'"}) {
    INFO(more);
    const TemporaryFolder folder;
    const auto design = [&](const std::string& name, const std::string& evaluations,
                            const std::string& resume) {
      return program_run("design '" + paper + "start_a.toml' --quiet" + small + " " + more +
                         " --set search.most_evaluations=" + evaluations + into(folder, name) + resume);
    };
    const Ended whole = design("whole", "40", "");
    REQUIRE((whole.code == 0 || whole.code == 5));
    const Ended part = design("part", "12", "");
    INFO(part.output);
    REQUIRE(part.code == 5);
    const json saved = parsed(folder / "part" / "checkpoint.json");
    CHECK(saved["answers"].size() <= 12);
    const Ended resumed = design("part", "40", " --resume");
    INFO(resumed.output);
    if (more.find("kernels") != std::string::npos) {  // each kernel's share depends on the whole budget
      CHECK(resumed.code == 3);
      CHECK_THAT(resumed.output, Contains("the saved search is not this one"));
      continue;
    }
    CHECK(resumed.code == whole.code);
    check_same_files(folder / "whole", folder / "part");
  }
}

TEST_CASE("a checkpoint that does not fit is refused with the reason, and none at all is no error") {
  const TemporaryFolder folder;
  const std::string limited =
      "design '" + paper + "start_a.toml'" + small + " --set search.most_evaluations=10" + into(folder, "a");
  const Ended first = program_run(limited + " --resume");
  CHECK(first.code == 5);
  CHECK_THAT(first.output, Contains("no checkpoint in") && Contains("begins anew") && Contains("--resume"));
  const std::filesystem::path file = folder / "a" / "checkpoint.json";
  const std::string good = read_whole(file);
  const auto refused = [&](const std::string& arguments, const std::string& words) {
    const Ended ended = program_run(limited + " --resume " + arguments);
    INFO(ended.output);
    CHECK(ended.code == 3);
    CHECK_THAT(ended.output, Contains(file.string()) && Contains(words));
  };
  refused("--set source.power=41", "of another scene");
  refused("--seed 9", "of another scene");
  json other = json::parse(good);
  other["version"] = "0.0.1 (cafe)";
  write_whole(file, other.dump());
  refused("", "written by 0.0.1 (cafe)");
  for (const std::string& broken :
       {std::string(), good.substr(0, good.size() / 2), std::string("[]"), std::string("{\"version\":1}"),
        std::string(100'000, '['), std::string("\0\xff", 2)}) {
    write_whole(file, broken);
    refused("", "cannot be read");
  }
  for (const char* answers : {"[[]]", "[[1]]", "[7]", "[[\"a\", 1]]", "{}", "[[1, 2, \"x\"]]"}) {
    other = json::parse(good);
    other["answers"] = json::parse(answers);
    write_whole(file, other.dump());
    INFO(answers);
    const Ended ended = program_run(limited + " --resume");
    INFO(ended.output);
    CHECK((ended.code == 3 || other["answers"].empty()));
  }
  write_whole(file, good);
  CHECK(program_run(limited + " --resume --threads 1 --set search.most_evaluations=11").code == 5);
}

TEST_CASE("a folder that cannot be written, or has no room, is found before the search and ends with 6") {
  const TemporaryFolder folder;
  write_whole(folder / "file", "x");
  const auto begin = std::chrono::steady_clock::now();
  const Ended blocked = program_run(slow + " --out '" + (folder / "file" / "out").string() + "'");
  CHECK(blocked.code == 6);
  CHECK_THAT(blocked.output, Contains("cannot make the output folder"));
  for (const std::string command : {"design", "simulate", "export", "sensitivity", "tradeoff", "landscape"}) {
    INFO(command);
    const Ended full = run_shell("ulimit -f 100; '" + program + "' " + command + " '" + paper +
                                 "start_a.toml'" + into(folder, command));
    INFO(full.output);
    CHECK(full.code == 6);
    CHECK_THAT(full.output, Contains("no room") && Contains("free space"));
    CHECK(std::filesystem::is_empty(folder / command));
  }
  CHECK(std::chrono::steady_clock::now() - begin < std::chrono::seconds(20));
}

// unsanitized: it limits the address space, of which asan reserves terabytes
TEST_CASE("what a scene takes of memory is said before, and what would not fit is refused", "[unsanitized]") {
  const TemporaryFolder folder;
  const std::string scene = "'" + paper + "start_a.toml' ";
  const Ended batches = program_run("explain " + scene + "--set model.photons=1000000000");
  CHECK_THAT(batches.output, Contains("memory") && Contains("summed batch by batch"));
  std::string text = read_whole(paper + "start_a.toml");
  const std::string radius = "photons = 100000\nkernel_radius = 0.5";
  REQUIRE(text.find(radius) != std::string::npos);
  text.replace(text.find(radius), radius.size(),
               "neighbours = 500\nphotons = 4000000000\nrung = \"photons\"");
  write_whole(folder / "kept.toml", text);
  const std::string kept = "'" + (folder / "kept.toml").string() + "'" + into(folder, "a");
  const Ended said = program_run("explain '" + (folder / "kept.toml").string() + "'");
  CHECK_THAT(said.output, Contains("memory") && Contains("144 GB") && Contains("all photons are kept"));
  for (const std::string command : {"simulate ", "design ", "landscape "}) {
    const Ended refused = run_shell("ulimit -v 8000000; '" + program + "' " + command + kept);
    INFO(refused.output);
    CHECK(refused.code == 3);
    CHECK_THAT(refused.output, Contains("model.photons: the scene would not fit into memory") &&
                                   Contains("GB are free") && Contains("kernel_radius"));
    CHECK_FALSE(std::filesystem::exists(folder / "a"));
  }
}
