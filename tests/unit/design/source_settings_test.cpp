#include <catch2/catch.hpp>
#include <set>
#include <string>
#include <string_view>

#include "base/errors.h"
#include "design/keys.h"
#include "design/run.h"
#include "support/ray_bytes.h"
#include "support/temporary_folder.h"

using namespace catoptric;
using namespace catoptric::design;

namespace {

Scene scene_of(const std::string& source, const std::string& more = "") {
  const std::string text = "unit = \"cm\"\n[source]\nposition = [0, 0, 5]\npower = 2\n" + source +
                           "\n[reflector]\npoints = [[0, 10], [5, 10], [10, 5]]\n[near_field]\nradius = 8\n" +
                           more;
  return make_scene(Settings::parse(text, "test.toml", scene_keys()));
}

}  // namespace

TEST_CASE("a source's keys make the source, in mm") {
  const Scene disc = scene_of("kind = \"disc\"\nradius = 0.5\naxis = [0, 0, 2]");
  CHECK(disc.source.kind == SourceKind::disc);
  CHECK(disc.source.radius_mm == 5);
  CHECK(make_source(disc.source)->extent_mm() == 5);
  CHECK(make_source(disc.source)->intensity_w_per_sr({0, 0, 1}) == Approx(2 / pi));
  const Scene beam = scene_of("exponent = 3\naxis = [1, 0, 0]");
  CHECK(make_source(beam.source)->intensity_w_per_sr({1, 0, 0}) == Approx(2 * 4 / (2 * pi)));
  CHECK(make_source(scene_of("").source)->intensity_w_per_sr({1, 0, 0}) == 2 / (4 * pi));
}

TEST_CASE("surfaces are made from their keys, and written back as they are") {
  for (const char* text : {"kind = \"rectangle\"\nwidth = 0.4\nheight = 0.2\nalong = [0, 1, 0]",
                           "kind = \"sphere\"\nradius = 0.2",
                           "kind = \"cylinder\"\nradius = 0.1\nlength = 0.8\naxis = [1, 0, 0]"}) {
    const Scene scene = scene_of(text);
    CHECK(scene_text(make_scene(Settings::parse(scene_text(scene), "test.toml", scene_keys()))) ==
          scene_text(scene));
  }
  const auto extent = [](const char* text) { return make_source(scene_of(text).source)->extent_mm(); };
  CHECK(extent("kind = \"rectangle\"\nwidth = 0.6\nheight = 0.8") == Approx(5));
  CHECK(extent("kind = \"sphere\"\nradius = 0.2") == 2);
  CHECK(extent("kind = \"cylinder\"\nradius = 0.3\nlength = 0.8") == Approx(5));
  CHECK_THROWS_WITH(scene_of("kind = \"sphere\"\nradius = 1\naxis = [0, 0, 1]"),
                    Catch::Contains("source.axis"));
  CHECK_THROWS_WITH(scene_of("kind = \"cylinder\"\nradius = 1"), Catch::Contains("source.length"));
  CHECK_THROWS_WITH(scene_of("kind = \"rectangle\"\nwidth = 1\nheight = 1\nradius = 1"),
                    Catch::Contains("source.radius"));
  CHECK_THROWS_WITH(scene_of("kind = \"rectangle\"\nwidth = 1\nheight = 1\nalong = [0, 0, 1]"),
                    Catch::Contains("source.along"));
}

TEST_CASE("a key of some kinds of source is refused by a point and never passed over") {
  const std::set<std::string> of_a_point{"kind", "position", "power", "flux", "exponent", "axis"};
  int others = 0;
  for (const Key& key : scene_keys()) {
    if (!key.path.starts_with("source.")) continue;
    const std::string name(key.path.substr(std::string_view("source.").size()));
    if (of_a_point.contains(name)) continue;
    const std::string value = key.type == KeyType::text      ? "\"a\""
                              : key.type == KeyType::numbers ? "[1.0, 0.0, 0.0]"
                                                             : "1.0";
    CHECK_THROWS_WITH(scene_of(name + " = " + value),
                      Catch::Contains("source." + name) && Catch::Contains("does not belong to this source"));
    ++others;
  }
  CHECK(others > 0);
}

TEST_CASE("a photometric file makes the source, and its name is kept whole") {
  const test::TemporaryFolder folder;
  test::write_whole(folder / "beam.ies",
                    "IES:LM-63-2019\nTILT=NONE\n1 -1 1 3 1 1 2 0 0 0\n1 1 5\n0 45 90\n0\n100 50 0\n");
  const std::string file = (folder / "beam.ies").string();
  const Scene scene = scene_of("kind = \"intensity\"\nfile = \"" + file + "\"\naxis = [0, 0, -1]");
  const auto source = make_source(scene.source);
  CHECK(source->power_w() == 2);
  CHECK(source->intensity_w_per_sr({0, 0, 1}) == 0);
  CHECK(source->intensity_w_per_sr({0, 0, -1}) ==
        Approx(2 * source->intensity_w_per_sr({std::sqrt(0.5), 0, -std::sqrt(0.5)})));
  const std::string text = scene_text(scene);
  CHECK_THAT(text, Catch::Contains(file));
  CHECK(scene_text(make_scene(Settings::parse(text, "elsewhere/test.toml", scene_keys()))) == text);
  const Scene own = make_scene(
      Settings::parse("source.kind = \"intensity\"\nsource.file = \"" + file +
                          "\"\nreflector.points = [[0, 10], [5, 10], [10, 5]]\nnear_field.radius = 8\n",
                      "test.toml", scene_keys()));
  CHECK(own.source.quantity == LightQuantity::luminous);
  CHECK(own.source.power_w == Approx(own.source.table->flux()).epsilon(1e-15));
  CHECK_THROWS_WITH(scene_of("kind = \"intensity\""), Catch::Contains("source.file"));
  CHECK_THROWS_WITH(scene_of("kind = \"intensity\"\nfile = \"none.ies\""), Catch::Contains("none.ies"));
  CHECK_THROWS_WITH(scene_of("file = \"beam.ies\""), Catch::Contains("source.file"));
}

TEST_CASE("a ray file makes the source, placed and turned, with its own light or the scene's") {
  const test::TemporaryFolder folder;
  test::write_whole(folder / "led.tm25ray", test::tm25_file(3, test::three_rays()));
  const auto scene = [&](const std::string& more) {
    const std::string text = "source.kind = \"rays\"\nsource.file = \"" + (folder / "led.tm25ray").string() +
                             "\"\nreflector.points = [[0, 10], [5, 10], [10, 5]]\nnear_field.radius = 8\n" +
                             more;
    return make_scene(Settings::parse(text, "test.toml", scene_keys()));
  };
  const Scene own = scene("source.position = [1, 0, 0]\nsource.axis = [0, 0, -1]\n");
  CHECK(own.source.quantity == LightQuantity::radiant);
  CHECK(own.source.power_w == 3);
  const auto source = make_source(own.source);
  CHECK(source->is_sampled());
  // Two rays carry 1 and 2 W: the first third of the numbers picks the first.
  const auto emission = source->emission();
  const Ray first = emission->emit({0.3, 0, 0, 0}), second = emission->emit({0.4, 0, 0, 0});
  CHECK((first.origin_mm - Vector3(2, -2, -3)).norm() < 1e-6);
  CHECK((first.direction - Vector3(0, 0, -1)).norm() < 1e-6);
  CHECK((second.origin_mm - Vector3(5, -5, -6)).norm() < 1e-6);
  CHECK((second.direction - Vector3(0.6, 0, 0.8)).norm() < 1e-6);
  CHECK(scene("source.flux = 100\n").source.power_w == 100);
  const std::string text = scene_text(own);
  CHECK(scene_text(make_scene(Settings::parse(text, "elsewhere/test.toml", scene_keys()))) == text);
  CHECK_THROWS_WITH(scene("source.exponent = 1\n"), Catch::Contains("source.exponent"));
  CHECK_NOTHROW(scene("model.replicates = 8\n"));
  CHECK_THROWS_WITH(scene("model.replicates = 9\n"), Catch::Contains("model.replicates"));
  CHECK_THROWS_WITH(scene("start = \"tailored\"\ntarget.kind = \"uniform\"\ntarget.radius = 3\n"
                          "target.irradiance = 1\n"),
                    Catch::Contains("source.kind"));
  test::write_whole(folder / "led.tm25ray", test::tm25_file(4, test::three_rays()));
  CHECK_THROWS_WITH(scene(""), Catch::Contains("led.tm25ray"));
}

TEST_CASE("several sources have keys of their own, and are in watts or in lumens together") {
  const auto scene = [](const std::string& sources) {
    return make_scene(
        Settings::parse("unit = \"cm\"\n" + sources +
                            "reflector.points = [[0, 10], [5, 10], [10, 5]]\nnear_field.radius = 8\n",
                        "test.toml", scene_keys()));
  };
  const std::string lamp = "sources.lamp.position = [0, 1, 5]\nsources.lamp.power = 2\n",
                    chip =
                        "sources.chip.kind = \"disc\"\nsources.chip.radius = 0.5\nsources.chip.power = 3\n";
  const Scene both = scene(lamp + chip + "source.position = [0, 0, 1]\n");
  CHECK(both.source.kind == SourceKind::several);
  CHECK(both.source.power_w == 5);
  const auto source = make_source(both.source);
  CHECK(source->power_w() == 5);
  CHECK(source->position_mm() == Vector3(0, 5, 35));
  const std::string text = scene_text(both);
  CHECK_THAT(text, Catch::Contains("[sources.lamp]") && Catch::Contains("\"several\""));
  CHECK(scene_text(make_scene(Settings::parse(text, "test.toml", scene_keys()))) == text);
  SourceSpec brighter = both.source;
  brighter.power_w *= 2;
  CHECK(make_source(brighter)->power_w() == 10);
  CHECK_THROWS_WITH(scene(lamp + "source.power = 1\n"), Catch::Contains("source.power"));
  CHECK_THROWS_WITH(scene(lamp + "source.kind = \"disc\"\n"), Catch::Contains("source.kind"));
  CHECK_THROWS_WITH(scene("source.kind = \"several\"\n"), Catch::Contains("source.kind"));
  CHECK_THROWS_WITH(scene(lamp + "sources.b.kind = \"several\"\nsources.b.power = 1\n"),
                    Catch::Contains("sources.b.kind"));
  CHECK_THROWS_WITH(scene(lamp + "sources.b.flux = 1\n"), Catch::Contains("mixes"));
  CHECK_THROWS_WITH(scene(lamp + "sources.b.radius = 1\n"), Catch::Contains("sources.b.radius"));
  CHECK_THROWS_WITH(scene(lamp + "sources.b.position = [0, 0, 1]\n"), Catch::Contains("sources.b.power"));
  CHECK_THROWS_WITH(scene(lamp + "sources.b.colour = 1\n"), Catch::Contains("colour"));
}

TEST_CASE("keys that do not belong to the source are refused") {
  CHECK_THROWS_WITH(scene_of("radius = 1"), Catch::Contains("source.radius"));
  CHECK_THROWS_WITH(scene_of("axis = [0, 0, 1]"), Catch::Contains("source.axis"));
  CHECK_THROWS_WITH(scene_of("kind = \"disc\""), Catch::Contains("source.radius"));
  CHECK_THROWS_WITH(scene_of("kind = \"disc\"\nradius = 1\nexponent = 1"),
                    Catch::Contains("source.exponent"));
  CHECK_THROWS_WITH(scene_of("exponent = 1\naxis = [0, 0, 0]"), Catch::Contains("source.axis"));
  CHECK_THROWS_AS(scene_of("exponent = -1"), InputError);
  CHECK_THROWS_WITH(scene_of("exponent = 1", "[target]\nkind = \"paraboloid\"\nfocal_length = 5\n"),
                    Catch::Contains("formulas"));
}

TEST_CASE("scene.toml holds source and variables beside the shape, bit for bit") {
  const std::string variables =
      "[variables.w1]\nstep = 0.1\nlower = 0.3\nupper = 3\n"
      "[variables.\"source.z\"]\nstart = 5.1\nstep = 0.1\nlower = 4\nupper = 6\n"
      "[variables.\"source.exponent\"]\nstep = 0.1\nlower = 0.3\nupper = 3\n"
      "[variables.\"reflector.reflectance\"]\nstep = 0.1\nlower = 0.3\nupper = 1\n";
  const Scene first = scene_of("exponent = 0.7\naxis = [0, 0.1, 1]", variables);
  const std::string text = scene_text(first);
  CHECK_THAT(text, Catch::Contains("[variables.\"source.z\"]"));
  const Scene second = make_scene(Settings::parse(text, "test.toml", scene_keys()));
  CHECK(scene_text(second) == text);
  REQUIRE(second.variables.size() == 4);
  const std::vector<std::string> names{"w1", "source.z", "source.exponent", "reflector.reflectance"};
  for (std::size_t i = 0; i < 4; ++i) CHECK(second.variables[i].name == names[i]);
  CHECK(second.variables[1].start == 5.1);
  CHECK(second.variables[2].start == 0.7);
  CHECK(second.variables[3].start == 1);
  const Candidate start = start_candidate(second);
  CHECK(start.source.position_mm.z() == 51);
  CHECK(start.source.exponent == 0.7);
  const Scene disc = scene_of("kind = \"disc\"\nradius = 0.5");
  CHECK(scene_text(make_scene(Settings::parse(scene_text(disc), "test.toml", scene_keys()))) ==
        scene_text(disc));
}

TEST_CASE("a family moves source and surface, and knows what is no source") {
  const Scene scene = scene_of("exponent = 1");
  const SceneFamily family(scene.with(scene.profile),
                           {"source.x", "w1", "reflector.reflectance", "source.power"},
                           LengthUnit::centimetre);
  const auto moved = family.at(std::vector<double>{0.3, 1.5, 0.6, 7});
  REQUIRE(moved);
  CHECK(moved->source.position_mm == Vector3(3, 0, 50));
  CHECK(moved->profile.points()[1].weight == 1.5);
  CHECK(moved->mirror.reflectance == 0.6);
  CHECK(moved->source.power_w == 7);
  CHECK_FALSE(family.at(std::vector<double>{0, 1, 1.1, 7}));
  CHECK_FALSE(family.at(std::vector<double>{0, 1, 1, 0}));
  const SceneFamily luminous(scene.with(scene.profile), {"w1", "source.flux"}, LengthUnit::centimetre);
  CHECK_FALSE(luminous.at(std::vector<double>{1.5, 7}));  // this scene is in W
}

TEST_CASE("bounds that are no source's are refused") {
  const auto with = [](const char* name, const char* lower, const char* upper, const char* source) {
    return scene_of(source, std::string("[variables.\"") + name + "\"]\nstep = 0.1\nstart = 0.5\nlower = " +
                                lower + "\nupper = " + upper + "\n");
  };
  CHECK_NOTHROW(with("source.exponent", "0.1", "1", "exponent = 1"));
  CHECK_THROWS_WITH(with("source.exponent", "0", "1", "exponent = 1"), Catch::Contains("exponent"));
  CHECK_THROWS_WITH(with("source.exponent", "0.1", "1", "kind = \"disc\"\nradius = 1"),
                    Catch::Contains("point"));
  CHECK_THROWS_WITH(with("source.power", "0", "1", ""), Catch::Contains("power"));
  CHECK_THROWS_WITH(with("reflector.reflectance", "0", "1.2", ""), Catch::Contains("reflectance"));
  CHECK_THROWS_WITH(with("source.q", "0", "1", ""), Catch::Contains("source.z"));
}
