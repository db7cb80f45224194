#include "report/gnuplot.h"

#include <stdlib.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "base/errors.h"
#include "report/child_process.h"
#include "support/temporary_folder.h"

using namespace catoptric;
using namespace catoptric::report;
using namespace std::chrono_literals;
namespace fs = std::filesystem;

namespace {

constexpr const char* small_script = "set terminal svg\nplot x\n";

/// Sets an environment variable for a while.
struct Environment {
  std::string name, before;
  Environment(std::string name_, const std::string& value) : name(std::move(name_)) {
    if (const char* old = std::getenv(name.c_str())) before = old;
    ::setenv(name.c_str(), value.c_str(), 1);
  }
  ~Environment() { ::setenv(name.c_str(), before.c_str(), 1); }
};

void write(const fs::path& path, const std::string& text) { std::ofstream(path) << text; }

}  // namespace

TEST_CASE("without gnuplot the script stays and the reason is told") {
  const test::TemporaryFolder folder;
  write(folder.path() / "a.svg", "a picture of an earlier run");
  const Environment path("PATH", folder.path().string());
  const Drawing drawing = draw(small_script, folder.path(), "a");
  CHECK_FALSE(drawing.drawn());
  CHECK_THAT(drawing.sentence, Catch::Contains("gnuplot-nox") && Catch::Contains("a.gp"));
  CHECK(fs::exists(drawing.script));
  CHECK_FALSE(fs::exists(drawing.svg));
}

TEST_CASE("a gnuplot that fails, hangs or says nothing leaves no picture") {
  const test::TemporaryFolder folder;
  Drawing drawing = draw("set terminal svg\nplot x\nthis is no command\n", folder.path(), "broken");
  CHECK_FALSE(drawing.drawn());
  CHECK_THAT(drawing.sentence, Catch::Contains("line 3"));
  CHECK_FALSE(fs::exists(drawing.svg));
  CHECK_THAT(draw("set terminal svg\n", folder.path(), "silent").sentence, Catch::Contains("no picture"));
  GnuplotOptions hurried;
  hurried.time_limit = 300ms;
  const auto begin = std::chrono::steady_clock::now();
  drawing = draw("set terminal svg\nplot x\npause 60\n", folder.path(), "slow", hurried);
  CHECK_THAT(drawing.sentence, Catch::Contains("longer than 0.3 s"));
  CHECK(std::chrono::steady_clock::now() - begin < 30s);
}

TEST_CASE("the user's own gnuplot settings and odd folder names do not matter") {
  const test::TemporaryFolder folder;
  const fs::path odd = folder.path() / "- it's \"odd\" ; $(x) `y` é";
  fs::create_directories(odd);
  write(folder.path() / ".gnuplot", "exit status 7\n");
  const Environment home("HOME", folder.path().string());
  const Environment locale("LC_ALL", "de_DE.UTF-8");
  const Drawing drawing = draw(small_script, odd, "a");
  CHECK(drawing.sentence.empty());
  CHECK(drawing.drawn());
}

TEST_CASE("a folder that cannot be written to is an error of its own") {
  CHECK_THROWS_AS(draw(small_script, "/nonexistent/folder", "a"), IoError);
}

TEST_CASE("a child's outputs, code and end are reported") {
  ChildResult result = run_child({"sh", "-c", "echo out; echo err >&2; exit 3"}, 10s);
  CHECK(result.end == ChildResult::End::finished);
  CHECK(result.exit_code == 3);
  CHECK(result.output == "out\n");
  CHECK(result.errors == "err\n");
  CHECK(run_child({"sh", "-c", "kill -9 $$"}, 10s).exit_code == 128 + 9);
  CHECK(run_child({"catoptric-no-such-program"}, 10s).end == ChildResult::End::not_found);
  CHECK(run_child({"/"}, 10s).end == ChildResult::End::failed);
  // closes its outputs but does not end
  CHECK(run_child({"sh", "-c", "exec >&- 2>&-; sleep 60"}, 200ms).end == ChildResult::End::timed_out);
  // no shell in between: arguments arrive as they are
  CHECK(run_child({"printf", "%s", "$(id) 'x' *"}, 10s).output == "$(id) 'x' *");
  // more than a pipe holds, on both outputs
  result = run_child({"sh", "-c", "head -c 300000 /dev/zero; head -c 300000 /dev/zero >&2"}, 20s);
  CHECK(result.output.size() == 300000);
  CHECK(result.errors.size() == 300000);
  CHECK(run_child({"cat"}, 10s).output.empty());  // its input is empty, not ours
}
