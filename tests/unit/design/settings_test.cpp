#include "design/settings.h"

#include <catch2/catch.hpp>

using namespace catoptric;
using namespace catoptric::design;

namespace {

Settings scene(const std::string& text) { return Settings::parse(text, "folder/scene.toml", scene_keys()); }

/// The message that `text` is refused with.
std::string refusal(const std::string& text) {
  try {
    scene(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

bool has(const std::string& message, const std::string& part) {
  return message.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("values come back with their type and their line") {
  const Settings settings = scene("unit = \"cm\"\nseed = 7\n[source]\npower = 2\nposition = [0, 0.5, 1]\n");
  CHECK(settings.text("unit") == "cm");
  CHECK(settings.integer("seed") == 7);
  CHECK(settings.number("source.power") == 2.0);
  CHECK(settings.numbers("source.position") == Numbers{0, 0.5, 1});
  CHECK(settings.where("source.power") == "folder/scene.toml:4");
  CHECK_FALSE(settings.number("model.kernel_radius"));
  CHECK(settings.folder() == "folder");
}

TEST_CASE("an unknown key is refused with file, line, key and the nearest known one") {
  const std::string message = refusal("[model]\nphotons = 5\nkernel_radus = 1\n");
  CHECK(has(message, "folder/scene.toml:3"));
  CHECK(has(message, "model.kernel_radus"));
  CHECK(has(message, "did you mean model.kernel_radius?"));
  CHECK(has(refusal("photons = 5"), "did you mean model.photons?"));
  CHECK(has(refusal("[lamp]\nwatts = 5"), "unknown key lamp.watts"));
  CHECK(has(refusal("[variables.w1]\nstp = 1"), "unknown key variables.w1.stp"));
}

TEST_CASE("a wrong type and a value out of range name the rule") {
  CHECK(has(refusal("seed = \"one\""), "it must be a whole number"));
  CHECK(has(refusal("seed = 1.5"), "whole number"));
  CHECK(has(refusal("seed = -1"), "out of range"));
  CHECK(has(refusal("[source]\npower = 0"), ">= 1e-30"));
  CHECK(has(refusal("[source]\npower = nan"), "out of range"));
  CHECK(has(refusal("[source]\npower = inf"), "out of range"));
  CHECK(has(refusal("[source]\npower = true"), "it must be a number"));
  CHECK(has(refusal("[source]\nposition = [0, 0]"), "a list of 3 numbers"));
  CHECK(has(refusal("[source]\nposition = [0, 0, nan]"), "out of range"));
  CHECK(has(refusal("unit = \"furlong\""), "one of \"mm\", \"cm\", \"m\", \"in\""));
  CHECK(has(refusal("[reflector]\npoints = [[0, 1], [2]]"), "out of range"));
  CHECK(has(refusal("[reflector]\nweights = [1, 0]"), "out of range"));
  CHECK(has(refusal("[reflector]\nreflectance = 1.1"), "<= 1"));
  CHECK(has(refusal("source = 5"), "unknown key source"));
  CHECK(has(refusal("[[source]]\npower = 1"), "unknown key source"));
  CHECK(has(refusal("[near_field]\nreal = 1"), "true or false"));
}

TEST_CASE("text that is no TOML is refused with line and column") {
  const std::string message = refusal("unit = \"cm\"\nseed = = 3\n");
  CHECK(has(message, "folder/scene.toml:2:"));
  CHECK(has(message, "not valid TOML"));
  CHECK(has(refusal("seed = 1\nseed = 2"), ":2:"));
}

TEST_CASE("overrides are checked like the file, and may leave quotes to the shell") {
  Settings settings = scene("unit = \"cm\"");
  settings.set({"unit", "mm", "--set"});
  settings.set({"model.photons", "1000", "--set"});
  settings.set({"source.position", "[1, 2, 3]", "--set"});
  CHECK(settings.text("unit") == "mm");
  CHECK(settings.integer("model.photons") == 1000);
  CHECK(settings.numbers("source.position") == Numbers{1, 2, 3});
  CHECK_THROWS_WITH(settings.set({"model.photon", "1", "--set"}),
                    Catch::Contains("did you mean model.photons"));
  CHECK_THROWS_WITH(settings.set({"model.photons", "many", "--set"}), Catch::Contains("whole number"));
  CHECK_THROWS_AS(settings.set({"seed", "1\nthreads = 2", "--set"}), InputError);
}

TEST_CASE("edit distance counts a swap once") {
  CHECK(edit_distance("kernel", "kernel") == 0);
  CHECK(edit_distance("kernel", "kenrel") == 1);
  CHECK(edit_distance("", "abc") == 3);
}

TEST_CASE("every key says what it means and what it asks for") {
  for (const auto keys : {scene_keys(), study_keys()})
    for (const Key& key : keys) {
      INFO(key.path);
      CHECK_FALSE(key.meaning.empty());
      CHECK_FALSE(rule(key).empty());
      CHECK(find_key(keys, key.path) == &key);
    }
}
