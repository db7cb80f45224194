#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "support/catoptric_program.h"
#include "support/temporary_folder.h"

/// What a person sees on a terminal, and what a program or a shell is told instead.

using namespace catoptric::test;
using Catch::Contains;
using nlohmann::json;

namespace {

/// Standard output alone, each line as JSON.
std::vector<json> events(const std::string& arguments, int code) {
  const Ended ended = run_shell("('" + program + "' " + arguments + " --json 2>/dev/null)");
  INFO(ended.output);
  CHECK(ended.code == code);
  std::vector<json> list;
  std::istringstream in(ended.output);
  for (std::string line; std::getline(in, line);)
    list.push_back(json::parse(line));  // throws where it is none
  REQUIRE(!list.empty());
  CHECK(list.back() == json({{"event", "end"}, {"exit_code", code}}));
  return list;
}

/// As on a terminal, which `script` pretends to be.
Ended on_terminal(const std::string& environment, const std::string& arguments) {
  return run_shell("env -u NO_COLOR " + environment + " script -qec \"'" + program + "' " + arguments +
                   "\" /dev/null");
}

std::string in_bash(const std::string& words, int at) {
  return run_shell("bash --norc -c 'source <(\"" + program + "\" completion bash); COMP_WORDS=(" + words +
                   "); COMP_CWORD=" + std::to_string(at) +
                   "; _catoptric 2>/dev/null; echo \"${COMPREPLY[*]}\"'")
      .output;
}

}  // namespace

TEST_CASE("a mistyped command or option is answered with the one that may have been meant") {
  const auto refused = [](const std::string& arguments, const std::string& part) {
    const Ended ended = program_run(arguments);
    INFO(ended.output);
    CHECK(ended.code == 2);
    CHECK_THAT(ended.output, Contains(part));
  };
  refused("desing a.toml", "\"desing\" is no command. Try: did you mean design?");
  refused("tradeof a.toml", "did you mean tradeoff?");
  refused("xyz", "catoptric --help lists them");
  refused("design a.toml --thraeds 2", "design has no option --thraeds. Try: did you mean --threads?");
  refused("design a.toml --sett=a=1", "did you mean --set?");
  refused("design a.toml --xyz", "Try: catoptric design --help");
}

TEST_CASE("a program is told in JSON lines: beginning, progress, files with their result, end") {
  const TemporaryFolder folder;
  const auto told =
      events("design '" + paper + "start_a.toml' --out '" + (folder / "a").string() + "'" + small, 0);
  CHECK(told.front()["event"] == "begin");
  CHECK(told.front()["folder"] == (folder / "a").string());
  std::size_t searching = 0;
  const json* written = nullptr;
  for (const json& event : told) {
    if (event["event"] == "progress" && event["phase"] == "search") {
      ++searching;
      CHECK(event["evaluations"] > 0);
      CHECK(event["share"] >= 0);
      CHECK(event["unit"] == "W/m^2");
    }
    if (event["event"] == "written") written = &event;
  }
  CHECK(searching > 0);
  REQUIRE(written);
  CHECK((*written)["result"] == parsed(folder / "a" / "result.json"));
  CHECK((*written)["files"].size() > 5);
  const auto refused = events("simulate /nonexistent.toml", 3);
  REQUIRE(refused.size() == 2);
  CHECK(refused[0]["event"] == "error");
  CHECK_THAT(refused[0]["where"].get<std::string>(), Contains("nonexistent"));
  CHECK(events("design '" + paper + "start_a.toml' --thraeds 1", 2)[0]["hint"] == "did you mean --threads?");
  const auto plans = events("explain '" + paper + "start_a.toml'", 0);
  REQUIRE(plans.size() == 3);
  CHECK(plans[0]["rung"] == "tubes");
  CHECK(plans[1]["purpose"] == "search");
}

TEST_CASE("colours are for terminals, and NO_COLOR is honoured") {
  const std::string escape = "\x1b[";
  const std::string wrong = "simulate /nonexistent.toml";
  CHECK_THAT(on_terminal("TERM=xterm", wrong).output, Contains(escape));
  CHECK_THAT(on_terminal("TERM=xterm NO_COLOR=1", wrong).output,
             Contains("nonexistent") && !Contains(escape));
  CHECK_THAT(on_terminal("TERM=dumb", wrong).output, Contains("nonexistent") && !Contains(escape));
  CHECK_THAT(program_run(wrong).output, Contains("nonexistent") && !Contains(escape));
}

TEST_CASE("a terminal shows iteration, best value and rate on one line of its width") {
  const TemporaryFolder folder;
  const std::string arguments = "design '" + paper +
                                "start_a.toml' --set model.rung=photons --set model.photons=50000 --out '" +
                                (folder / "a").string() + "'";
  const std::string shown = on_terminal("TERM=xterm NO_COLOR=1", arguments).output;
  CHECK_THAT(shown, Contains("iteration ") && Contains("best ") && Contains("/s") && Contains(" evals"));
  std::istringstream in(shown);
  for (std::string bar; std::getline(in, bar, '\r');)
    if (bar.starts_with("[")) CHECK(bar.size() <= 80);
}

TEST_CASE("bash completes commands, options, keys and files") {
  CHECK_THAT(in_bash("catoptric des", 1), Contains("design"));
  CHECK_THAT(in_bash("catoptric design --thr", 2), Contains("--threads"));
  CHECK_THAT(in_bash("catoptric design a.toml --set model.phot", 4), Contains("model.photons="));
  CHECK_THAT(in_bash("catoptric export a.toml --format st", 4), Contains("step stl"));
  CHECK_THAT(in_bash("catoptric completion z", 2), Contains("zsh"));
  const std::string files = in_bash("catoptric simulate " + paper + "start_", 2);
  CHECK_THAT(files, Contains("start_a.toml") && Contains("start_c.toml"));
  CHECK_THAT(in_bash("catoptric simulate " + paper + "fig", 2), !Contains("figures.sh"));
  for (const char* shell : {"bash", "zsh", "fish"})
    CHECK_THAT(program_run(std::string("completion ") + shell).output,
               Contains("sensitivity") && Contains("resume"));
}

TEST_CASE("the manual names every command, option and key, and roff takes it without a warning") {
  const std::string manual = program_run("manual").output, scene = program_run("manual --scene").output;
  for (const char* part : {".SS design", ".SS study", "\\-\\-resume", "NO_COLOR", "interrupted"})
    CHECK_THAT(manual, Contains(part));
  std::istringstream keys(program_run("--keys").output);
  std::size_t count = 0;
  for (std::string key; std::getline(keys, key);) {
    if (key.empty() || key[0] == ' ') continue;
    ++count;
    CHECK_THAT(scene, Contains("\\fB" + key + "\\fR"));
  }
  CHECK(count > 100);
  if (run_shell("command -v groff").code != 0) return;
  for (const char* page : {"manual", "manual --scene"})
    CHECK(run_shell("'" + program + "' " + page + " | groff -man -Tutf8 -ww -z").output == "");
}
