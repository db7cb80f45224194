#include "design/surface_settings.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "base/units.h"
#include "design/scene.h"

using namespace catoptric;
using namespace catoptric::design;

namespace {

Scene scene(const std::string& reflector, const std::string& more = "") {
  return make_scene(
      Settings::parse("[source]\nposition = [0, 0, 50]\npower = 10\n"
                      "[reflector]\npoints = [[0, 100], [50, 100], [100, 50]]\n" +
                          reflector + "\n[near_field]\nradius = 50\n" + more,
                      "s.toml", scene_keys()));
}

void refused(const std::string& reflector, const std::string& key, const std::string& part,
             const std::string& more = "") {
  INFO(reflector << more);
  CHECK_THROWS_WITH(scene(reflector, more), Catch::Contains(key) && Catch::Contains(part));
}

}  // namespace

TEST_CASE("a mirror's surface is what its keys say") {
  CHECK(scene("").mirror == sim::Material{1, 0});
  CHECK(scene("reflectance = 0.6\nroughness = 0.2\ndiffuse = 0.1\ntransmittance = 0.3").mirror ==
        sim::Material{0.6, 0.3, 0.1, 0.2});
  CHECK(scene("index = 1.1\nextinction = 6.6").mirror == sim::Material::metal(1.1, 6.6));
  const sim::Material table =
      scene("angles = [0, 60, 90]\nreflectances = [0.9, 0.8, 1]\nroughness = 0.1").mirror;
  CHECK(table.roughness == 0.1);
  CHECK(table.reflectance_at(0.5) == Approx(0.8));
  CHECK(table.reflectance_at(std::cos(pi / 6)) == Approx(0.85));
}

TEST_CASE("a real near field's reflectance is diffuse, its specular share is not") {
  const auto floor =
      scene("", "real = true\nreflectance = 0.4\nspecular = 0.3\nroughness = 0.2\ntransmittance = 0.1")
          .near_field.material();
  REQUIRE(floor);
  CHECK(*floor == sim::Material{0.3, 0.1, 0.4, 0.2});
  CHECK(*scene("", "real = true").near_field.material() == sim::Material::matt(0));
  refused("", "near_field.specular", "invisible", "specular = 0.3");
  refused("", "near_field.reflectance", "more light", "real = true\nreflectance = 0.6\nspecular = 0.5");
}

TEST_CASE("a surface that is described twice or by half is refused with its key") {
  refused("reflectance = 0.9\nindex = 1.1\nextinction = 6.6", "reflector.reflectance", "twice");
  refused("reflectance = 1.0\nangles = [0, 90]\nreflectances = [0.9, 1]", "reflector.reflectance", "twice");
  refused("index = 1.1\nextinction = 6.6\nangles = [0, 90]\nreflectances = [0.9, 1]", "reflector.index",
          "twice");
  refused("index = 1.1", "reflector.index", "stands alone");
  refused("extinction = 1.1", "reflector.extinction", "stands alone");
  refused("angles = [0, 90]", "reflector.angles", "stands alone");
  refused("angles = [0, 90]\nreflectances = [0.9]", "reflector.angles", "2 angles for 1");
  refused("angles = [0, 30, 30]\nreflectances = [0.9, 0.8, 0.7]", "reflector.angles", "rise");
  refused("angles = [0, 91]\nreflectances = [0.9, 0.8]", "reflector.angles", "90");
  refused("angles = [0, 90]\nreflectances = [0, 0]", "reflector.angles", "nothing is reflected");
}

TEST_CASE("shares above 1 are refused with what adds up to them") {
  refused("diffuse = 0.1", "reflector.diffuse", "reflectance 1 + diffuse 0.1");
  refused("reflectance = 0.6\ndiffuse = 0.3\ntransmittance = 0.2", "reflector.transmittance", "above 1");
  refused("index = 1.1\nextinction = 6.6\ndiffuse = 0.1", "reflector.diffuse", "grazing");
  refused("angles = [0, 80]\nreflectances = [0.5, 0.95]\ndiffuse = 0.1", "reflector.diffuse",
          "greatest reflectance 0.95");
  refused("roughness = 1e-9", "reflector.roughness", "too fine");
  refused("roughness = 1.5", "reflector.roughness", "1");
}

TEST_CASE("a scene with a surface of its own reads back as it was") {
  for (const char* reflector :
       {"reflectance = 0.6\nroughness = 0.2\ndiffuse = 0.1", "index = 1.1\nextinction = 6.6",
        "angles = [0, 33.3, 90]\nreflectances = [0.9, 0.8123456789012345, 1]\nroughness = 0.1"}) {
    const Scene first = scene(reflector, "real = true\nreflectance = 0.4\nspecular = 0.3\nroughness = 0.2");
    const std::string text = scene_text(first);
    const Scene again = make_scene(Settings::parse(text, "again.toml", scene_keys()));
    CHECK(again.mirror == first.mirror);
    CHECK(*again.near_field.material() == *first.near_field.material());
    CHECK(scene_text(again) == text);
  }
}

TEST_CASE("what takes one reflectance refuses a course of them") {
  const std::string metal = "index = 1.1\nextinction = 6.6";
  refused(metal, "reflector.reflectance", "goes with the angle",
          "[variables.\"reflector.reflectance\"]\nstart = 0.5\nstep = 0.1\nlower = 0.3\nupper = 1");
  const std::string tailored = "[target]\nkind = \"uniform\"\nradius = 40\nirradiance = 900\n";
  const auto start = [&](const std::string& reflector) {
    return make_scene(Settings::parse(
        "start = \"tailored\"\n[source]\nposition = [0, 0, 50]\npower = 10\n"
        "[reflector]\n" +
            reflector + "\n[near_field]\nradius = 50\n" + tailored + "[constraints]\nrim_radius_max = 100\n",
        "s.toml", scene_keys()));
  };
  CHECK_THROWS_WITH(start(metal), Catch::Contains("reflector.index") && Catch::Contains("one reflectance"));
  CHECK_THROWS_WITH(start("angles = [0, 90]\nreflectances = [0.9, 0.8]"),
                    Catch::Contains("reflector.angles") && Catch::Contains("one reflectance"));
  CHECK_THROWS_WITH(start("reflectance = 0.8\ndiffuse = 0.1"),
                    Catch::Contains("reflector.diffuse") && Catch::Contains("matt"));
}
