#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>

#include "design/scene.h"
#include "fuzz/support/scene_check.h"

// What stands in a scene where a number is asked for: every key of the table, every number a reader may
// stumble over. Each ends as a message that names the key, or as a scene that is finite everywhere.

using namespace catoptric;
using namespace catoptric::design;

namespace {

const std::vector<std::string>& values() {
  static const std::vector<std::string> list{"nan",
                                             "inf",
                                             "-inf",
                                             "1e308",
                                             "-1e308",
                                             "1e-308",
                                             "4.9e-324",
                                             "1e-160",
                                             "0",
                                             "-0.0",
                                             "-1",
                                             "2",
                                             "1e12",
                                             "9223372036854775807",
                                             "-9223372036854775808",
                                             "99999999999999999999",
                                             "\"text\"",
                                             "\"\"",
                                             "true",
                                             "1979-05-27",
                                             "{a = 1}",
                                             "[]",
                                             "[[]]",
                                             "[[1, 2, 3]]",
                                             "[nan]"};
  return list;
}

const std::string head =
    "unit = \"cm\"\n[source]\nposition = [0, 0, 5]\npower = 0.0314\n[near_field]\nsamples = 4\n";
const std::string disc = "radius = 5\n";
const std::string bowl = "[reflector]\npoints = [[0, 10], [5, 10], [10, 5]]\n";

/// Scenes that between them have every key.
std::vector<std::string> scenes() {
  const std::string plain = head + disc + bowl;
  std::vector<std::string> list{
      plain +
          "wall = 0.2\n[variables.w1]\nstep = 0.5\nlower = 0.05\nupper = 20\n[landscape]\nvariables = "
          "[\"w1\"]\nlower = [0.1]\nupper = [3]\nsteps = [3]\npaths = true\n[constraints]\nrim_radius_min = "
          "1\n",
      head + "shape = \"rectangle\"\nwidth = 4\nheight = 3\nreal = true\n" + bowl +
          "[model]\nneighbours = 50\n",
      "accuracy = 0.1\n" + plain +
          "[search]\nfree = \"curvature\"\n[target]\nkind = \"gaussian\"\npeak = 1\nsigma = 2\n",
      "start = \"tailored\"\n" + head + disc +
          "[tailored]\nvertex = 5\n[target]\nkind = \"uniform\"\nradius = 3\nirradiance = 1\n",
      plain + "[target]\nkind = \"ring\"\ninner_radius = 1\nouter_radius = 3\nirradiance = 1\n",
      plain + "[target]\nkind = \"zones\"\nradii = [1, 2]\nirradiances = [2, 1]\n",
      plain + "[target]\nkind = \"paraboloid\"\nfocal_length = 5\n",
      plain + "[target]\nkind = \"reflector\"\npoints = [[0, 10], [5, 10], [10, 5]]\n",
      "[source]\nkind = \"disc\"\nradius = 1\npower = 1\n[near_field]\nradius = 5\n" + bowl,
      "[source]\npower = 1\nexponent = 2\n[near_field]\nradius = 5\n" + bowl,
  };
  return list;
}

/// The key's path with a name for its star.
std::string path_of(const Key& key) {
  std::string path(key.path);
  if (const auto star = path.find('*'); star != std::string::npos) path.replace(star, 1, "w1");
  return path;
}

/// The value where the key wants it: by itself, and in place of each number of its list.
std::vector<std::string> written(const Key& key, const std::string& value) {
  std::vector<std::string> list{value};
  const std::size_t count = key.count == 0 ? 2 : key.count;
  if (key.type == KeyType::numbers)
    for (std::size_t place = 0; place < count; ++place) {
      std::string text = "[";
      for (std::size_t i = 0; i < count; ++i)
        text += fmt::format("{}{}", i ? ", " : "", i == place ? value : "1");
      list.push_back(text + "]");
    }
  if (key.type == KeyType::points)
    for (const char* form : {"[[{}, 10], [5, 10], [10, 5]]", "[[0, 10], [5, {}], [10, 5]]"})
      list.push_back(fmt::format(fmt::runtime(form), value));
  return list;
}

bool is_finite(double value) { return std::isfinite(value); }
bool is_finite(const std::optional<double>& value) { return !value || std::isfinite(*value); }
template <typename Item>
bool is_finite(const std::vector<Item>& values) {
  for (const Item& value : values)
    if (!is_finite(value)) return false;
  return true;
}

struct FiniteSetting {
  bool operator()(double value) const { return std::isfinite(value); }
  bool operator()(const Numbers& value) const { return is_finite(value); }
  bool operator()(const Points& value) const { return is_finite(value); }
  template <typename Other>
  bool operator()(const Other&) const {
    return true;
  }
};

/// What of the scene is not finite, or nothing.
std::string not_finite(const Scene& scene) {
  for (const auto& [path, setting] : scene.settings.all())
    if (!std::visit(FiniteSetting{}, setting.value)) return path;
  for (const RationalSpan& span : scene.profile.spans())
    if (!is_finite(span.rw) || !is_finite(span.zw) || !is_finite(span.w)) return "spans";
  for (const double u : {scene.profile.first_parameter(), scene.profile.last_parameter()})
    if (!is_finite(scene.profile.at(u).r_mm) || !is_finite(scene.profile.at(u).z_mm)) return "ends";
  if (!is_finite(scene.profile.length_mm()) || !is_finite(scene.profile.area_mm2())) return "size";
  if (!scene.source.position_mm.allFinite() || !scene.source.axis.allFinite()) return "source";
  if (std::abs(scene.near_field.normal().norm() - 1) > 1e-12) return "normal";  // roundings of a unit vector
  for (const auto& sample : scene.near_field.samples(scene.samples))
    if (!sample.point_mm.allFinite()) return "samples";
  if (!is_finite(scene.target.radii_mm) || !is_finite(scene.target.irradiances_w_per_mm2)) return "target";
  if (!is_finite(scene.target.peak_w_per_mm2) || !is_finite(scene.target.reach_mm)) return "target";
  if (!is_finite(scene.model.estimate.kernel_radius_mm)) return "kernel";
  for (const optim::Variable& variable : scene.variables)
    if (!is_finite(variable.start) || !is_finite(variable.upper - variable.lower)) return variable.name;
  return "";
}

bool names_a_key(const std::string& message) {
  for (const Key& key : scene_keys())
    if (message.find(path_of(key)) != std::string::npos) return true;
  return message.find("variables.") != std::string::npos;
}

/// A scene of the settings, or the message.
struct Verdict {
  std::optional<Scene> scene;
  std::string message;
};

Verdict verdict(const std::function<Scene()>& make) {
  try {
    return {make(), ""};
  } catch (const InputError& error) {
    return {std::nullopt, error.what()};
  } catch (const CadError& error) {
    return {std::nullopt, error.what()};
  }
}

}  // namespace

TEST_CASE("every key refuses numbers that are none, or the scene is finite", "[long]") {
  std::size_t tried = 0, accepted = 0;
  for (const std::string& text : scenes()) {
    const Settings base = Settings::parse(text, "scene.toml", scene_keys());
    REQUIRE_NOTHROW(written_scene(base));
    for (const Key& key : scene_keys())
      for (const std::string& value : values())
        for (const std::string& put : written(key, value)) {
          ++tried;
          const std::string path = path_of(key);
          const Verdict found = verdict([&] {
            Settings settings = base;
            settings.set({path, put, "--set"});
            return written_scene(settings);
          });
          if (!found.scene) {
            INFO(path << " = " << put << ": " << found.message);
            const bool names_file =
                key.type == KeyType::text && found.message.find("file") != std::string::npos;
            CHECK((names_file || names_a_key(found.message)));
            continue;
          }
          ++accepted;
          INFO(path << " = " << put);
          CHECK(not_finite(*found.scene) == "");
          CHECK_NOTHROW(fuzz::check_scene(*found.scene));
        }
  }
  CHECK(tried > 40000);  // or keys or scenes are missing
  CHECK(accepted > 1000);
}

TEST_CASE("a number out of range or of the wrong kind is refused by its own key, with the file's line") {
  for (const Key& key : scene_keys()) {
    const std::string path = path_of(key);
    const bool number = key.type == KeyType::number || key.type == KeyType::integer ||
                        key.type == KeyType::numbers || key.type == KeyType::points;
    const bool text = key.type == KeyType::text || key.type == KeyType::texts;
    for (const std::string& value : {std::string("nan"), std::string("inf"), std::string("-inf"),
                                     std::string("true"), std::string("{a = 1}"), std::string("1979-05-27")})
      for (const std::string& put : written(key, value)) {
        if (key.type == KeyType::boolean && value == "true") continue;
        INFO(path << " = " << put);
        const Verdict found = verdict([&] {
          return written_scene(
              Settings::parse("seed = 1\n" + path + " = " + put + "\n", "s.toml", scene_keys()));
        });
        CHECK(found.message.find("s.toml:2") != std::string::npos);
        CHECK(found.message.find(path) != std::string::npos);
      }
    if (!number && !text) continue;
    INFO(path);
    const std::string wrong = number ? "\"text\"" : "1.5";
    CHECK_THROWS_WITH(Settings::parse(path + " = " + wrong, "s.toml", scene_keys()), Catch::Contains(path));
  }
}
