#include <fmt/format.h>
#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <filesystem>

#include "design/csv_table.h"
#include "design/scene.h"
#include "design/study.h"
#include "fuzz/targets/csv.h"
#include "fuzz/targets/override.h"
#include "fuzz/targets/scene.h"
#include "fuzz/targets/study.h"
#include "support/temporary_folder.h"

// Files that are none, or that mean ill. What is asked is always the same: a message, soon.

using namespace catoptric;
using namespace catoptric::design;
using test::TemporaryFolder;

namespace {

const std::string scene_start =
    "[source]\npower = 1\n[near_field]\nradius = 5\n[reflector]\npoints = [[0, 10], [5, 10], [10, 5]]\n";

Scene scene(const std::string& text) { return written_scene(Settings::parse(text, "s.toml", scene_keys())); }

std::string repeated(const std::string& text, std::size_t times) {
  std::string all;
  all.reserve(text.size() * times);
  for (std::size_t i = 0; i < times; ++i) all += text;
  return all;
}

/// The refusal of a text, checked to be short and soon. What takes seconds is no reading but a square of the
/// size.
std::string refusal(const std::string& text) {
  const auto begin = std::chrono::steady_clock::now();
  std::string message = "accepted";
  try {
    scene(text);
  } catch (const InputError& error) {
    message = error.what();
  }
  CHECK(std::chrono::steady_clock::now() - begin < std::chrono::seconds(20));
  CHECK(message.size() < 2000);
  return message;
}

}  // namespace

TEST_CASE("what is no ordinary file is refused by every reader, and nothing waits for it") {
  const TemporaryFolder folder;
  REQUIRE(::mkfifo((folder / "fifo").c_str(), 0600) == 0);
  std::filesystem::create_symlink(folder / "loop", folder / "loop");
  std::filesystem::create_directory(folder / "folder");
  const std::vector<std::pair<std::filesystem::path, std::string>> files{
      {folder / "fifo", "pipe or a device"},
      {"/dev/zero", "pipe or a device"},
      {folder / "loop", "cannot be read"},
      {folder / "folder", "folder"},
      {folder / "missing", "no such file"},
      {std::string(100000, 'x'), "cannot be read"},
      {"", "no such file"},
      {std::string("a\0b", 3), "NUL"},
      {folder / "fifo" / "below", ""}};
  for (const auto& [file, part] : files) {
    INFO(file.string().substr(0, 200));
    CHECK_THROWS_WITH(read_scene(file), Catch::Contains(part));
    CHECK_THROWS_WITH(read_study(file), Catch::Contains(part));
    CHECK_THROWS_WITH(read_csv_table(file), Catch::Contains(part));
    CHECK_THROWS_AS(read_scene(file), InputError);
    CHECK_THROWS_AS(read_study(file), InputError);
    CHECK_THROWS_AS(read_csv_table(file), InputError);
  }
}

TEST_CASE("texts that are no scene are refused soon and shortly") {
  for (const std::string& text : {std::string(),
                                  std::string("\0", 1),
                                  std::string("\xEF\xBB\xBF"),
                                  std::string("\r\n\r\n"),
                                  std::string("seed = 1\0\n", 10),
                                  std::string("title = \"\xff\xfe\""),
                                  repeated("[", 1000000),
                                  "seed = " + repeated("[", 1000000),
                                  "seed = " + repeated("{a = ", 100000),
                                  repeated("a", 1000000) + " = 1",
                                  repeated("a.", 500000) + "a = 1",
                                  "[" + repeated("a.", 500000) + "a]",
                                  repeated("'a'.", 500000) + "a = 1",
                                  "title = \"" + repeated("\\u0000", 10),
                                  repeated("seed = 1\n", 2),
                                  "unit = \"" + repeated("m", 1000000) + "\"",
                                  "seed = " + repeated("9", 1000000),
                                  "[source]\npower = 1." + repeated("0", 1000000) + "e",
                                  "model.rung = \"" + repeated("x", 1000000) + "\"",
                                  repeated("\"\"\"", 333333),
                                  "# " + repeated("x", 1000000)}) {
    INFO(text.substr(0, 60) << " of " << text.size());
    CHECK(refusal(text) != "accepted");
  }
}

TEST_CASE("names of more parts than any key has are refused before they overflow the stack") {
  CHECK(refusal("seed = 1\n" + repeated("a.", 500000) + "a = 1").find("s.toml:2") != std::string::npos);
  CHECK(refusal("x = {" + repeated("a . ", 500000) + "a = 1}").find("too many parts") != std::string::npos);
  Settings settings = Settings::parse(scene_start, "s.toml", scene_keys());
  CHECK_THROWS_AS(settings.set({"seed", "{" + repeated("a.", 500000) + "a = 1}", "--set"}), InputError);
  // Dots in texts, comments and numbers are no names.
  const std::string dots = repeated("a.", 200);
  CHECK(scene("title = \"" + dots + "\" # " + dots + "\n" + scene_start).title == dots);
  CHECK(scene("title = '''\n" + dots + "'''\n" + scene_start).title == dots);
  settings.set({"title", dots, "--set"});
  CHECK(settings.text("title") == dots);
}

TEST_CASE("a byte order mark, line ends of other systems and a last line without end make no difference") {
  const Scene plain = scene(scene_start);
  std::string dos;
  for (const char c : scene_start) dos += c == '\n' ? std::string("\r\n") : std::string(1, c);
  CHECK(scene("\xEF\xBB\xBF" + scene_start).profile == plain.profile);
  CHECK(scene(dos).profile == plain.profile);
  CHECK(scene(scene_start.substr(0, scene_start.size() - 1)).profile == plain.profile);
}

TEST_CASE("a generatrix of too many control points is refused, a long one is taken, both soon", "[long]") {
  const auto with_points = [](std::size_t count) {
    std::string points;
    for (std::size_t i = 0; i < count; ++i) points += fmt::format("{}[{}, 10]", i ? ", " : "", i);
    return "[source]\npower = 1\n[near_field]\nradius = 5\n[reflector]\npoints = [" + points + "]\n";
  };
  CHECK(refusal(with_points(1000000)).find("1000000 control points are too many") != std::string::npos);
  CHECK(scene(with_points(10000)).profile.points().size() == 10000);
  CHECK(refusal(scene_start + "[search]\nfree = \"profile\"\nrefine = [\"spans 2000000000\"]\n")
            .find("too many") != std::string::npos);
}

TEST_CASE("a table of a million columns or rows is read or refused in a moment") {
  const auto begin = std::chrono::steady_clock::now();
  CHECK(parse_csv_table("x\n" + repeated("1\n", 1000000), "t.csv").lines.size() == 1000000);
  const CsvTable wide =
      parse_csv_table(repeated("x,", 1000000) + "y\n" + repeated("1,", 1000000) + "1\n", "t.csv");
  CHECK(wide.names.size() == 1000001);
  try {
    column(wide, "z", "t.csv");
    FAIL("found");
  } catch (const InputError& error) {
    CHECK(std::string(error.what()).size() < 1000);
  }
  CHECK_THROWS_WITH(parse_csv_table("x\n" + repeated("1", 1000000), "t.csv"),
                    Catch::Contains("no finite number"));
  CHECK_THROWS_WITH(column(wide, "x", "t.csv"), Catch::Contains("which one is meant"));
  CHECK(std::chrono::steady_clock::now() - begin < std::chrono::seconds(20));
}

TEST_CASE("a study of very many runs is read in a moment") {
  std::string text = "scene = \"s.toml\"\n";
  for (int i = 0; i < 100000; ++i) text += fmt::format("[[runs]]\nname = \"{}\"\n", i);
  const auto begin = std::chrono::steady_clock::now();
  CHECK(parse_study(text, "study.toml").runs.size() == 100000);
  CHECK(std::chrono::steady_clock::now() - begin < std::chrono::seconds(20));
  CHECK_THROWS_WITH(parse_study(text + "[[runs]]\nname = \"7\"\n", "study.toml"),
                    Catch::Contains("two runs"));
}

TEST_CASE("a table's numbers have the ranges of a scene's") {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& kind, const std::string& table, const std::string& part) {
    test::write_whole(folder / "t.csv", table);
    INFO(kind << " " << table);
    CHECK_THROWS_WITH(make_target(scene("unit = \"m\"\n" + scene_start + "[target]\n" + kind +
                                        (folder / "t.csv").string() + "\"\n")),
                      Catch::Contains(part));
  };
  const std::string radial = "kind = \"radial\"\nfile = \"", csv = "kind = \"csv\"\nfile = \"",
                    intensity = "intensity_file = \"";
  refused(radial, "radius,irradiance\n0,1\n1e308,1\n", "t.csv:3");
  refused(radial, "radius,irradiance\n-1,1\n1,1\n", "t.csv:2");
  refused(radial, "radius,irradiance\n0,1e308\n1,1\n", "t.csv:2");
  refused(radial, "radius,irradiance\n0,-1\n1,1\n", "t.csv:2");
  refused(radial, "radius,radius,irradiance\n0,0,1\n", "which one is meant");
  refused(csv, "x,y,z,irradiance\n1e308,0,0,1\n", "t.csv:2");
  refused(csv, "x,y,z,irradiance\n0,0,0,1e300\n", "t.csv:2");
  refused(intensity, "angle,intensity\n0,1e300\n10,1\n", "t.csv:2");
  refused(intensity, "angle,intensity\n0,1\n1e300,1\n", "t.csv:3");
}

TEST_CASE("a file's name may hold quotes") {
  const TemporaryFolder folder;
  const auto file = folder / "it's a \"table\".csv";
  test::write_whole(file, "radius,irradiance\n0,1\n1,0\n");
  const Scene read =
      scene(scene_start + "[target]\nkind = \"radial\"\nfile = \"\"\"" + file.string() + "\"\"\"\n");
  CHECK(read.target.file == file);
}

TEST_CASE("text that is not in UTF-8 is refused from the command line too") {
  Settings settings = Settings::parse(scene_start, "s.toml", scene_keys());
  CHECK_THROWS_WITH(settings.set({"title", "caf\xe9", "--set"}), Catch::Contains("UTF-8"));
  settings.set({"title", "caf\xc3\xa9", "--set"});
  CHECK_NOTHROW(fuzz::check_scene(written_scene(settings)));
}

TEST_CASE("a direction too short to be one is refused, a short one is taken for what it is") {
  Settings settings = Settings::parse(scene_start, "s.toml", scene_keys());
  for (const char* short_one : {"[0, 0, 0]", "[0, 3e-160, 4e-160]", "[0, 0, 5e-324]"}) {
    settings.set({"near_field.normal", short_one, "--set"});
    CHECK_THROWS_WITH(written_scene(settings), Catch::Contains("has no direction"));
  }
  settings.set({"near_field.normal", "[0, 3e-90, 4e-90]", "--set"});
  CHECK((written_scene(settings).near_field.normal() - Vector3(0, 0.6, 0.8)).norm() < 1e-15);
}

TEST_CASE("inputs that once broke a reader end as they must") {
  const std::vector<std::pair<std::string, void (*)(std::string_view)>> readers{
      {"scene", fuzz::try_scene},
      {"override", fuzz::try_override},
      {"study", fuzz::try_study},
      {"csv", fuzz::try_csv}};
  for (const auto& [name, reader] : readers) {
    std::size_t count = 0;
    for (const auto& entry :
         std::filesystem::directory_iterator(std::string(CATOPTRIC_DATA) + "/fuzz/" + name)) {
      ++count;
      INFO(entry.path().string());
      CHECK_NOTHROW(reader(test::read_whole(entry.path())));
    }
    INFO(name);
    CHECK(count > 0);
  }
}
