#include "design/scene.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "design/run.h"
#include "design/target.h"

using namespace catoptric;
using namespace catoptric::design;

namespace {

const std::string data = CATOPTRIC_DATA;

/// A small complete scene; `more` is appended, `head` put before the tables.
std::string text(const std::string& more = "", const std::string& head = "unit = \"cm\"\n") {
  return head +
         "[source]\nposition = [0, 0, 5]\npower = 0.0314\n"
         "[reflector]\npoints = [[0, 10], [5, 10], [10, 5]]\n"
         "[near_field]\nradius = 5\n" +
         more;
}

Scene scene(const std::string& toml) { return make_scene(Settings::parse(toml, "s.toml", scene_keys())); }

void refused(const std::string& toml, const std::string& part) {
  INFO(toml);
  CHECK_THROWS_WITH(scene(toml), Catch::Contains(part));
}

}  // namespace

TEST_CASE("lengths are taken in the scene's unit, everywhere") {
  const Scene cm =
      scene(text("[model]\nkernel_radius = 0.5\n[target]\nkind = \"paraboloid\"\nfocal_length = 5\n"));
  CHECK(cm.source.position_mm == Vector3(0, 0, 50));
  CHECK(cm.profile.points()[2] == ControlPoint{100, 50, 1});
  CHECK(cm.profile.degree() == 2);
  CHECK(cm.near_field.half_width_mm() == 50);
  CHECK(cm.model.estimate.kernel_radius_mm == 5.0);
  CHECK(cm.target.focal_length_mm == 50);
  CHECK(cm.target.rim_radius_mm == 100);
  const Scene inch = scene(text("", "unit = \"in\"\n"));
  CHECK(inch.near_field.half_width_mm() == Approx(127).epsilon(1e-15));
}

TEST_CASE("the paper's scenes are what the paper says") {
  const Scene a = read_scene(data + "/paper/start_a.toml");
  CHECK(a.source.power_w == Approx(pi / 100).epsilon(1e-15));
  REQUIRE(a.variables.size() == 2);
  CHECK(a.variables[0].name == "w1");
  CHECK(a.variables[0].start == 1.6);
  CHECK(a.variables[0].step == 0.5);
  CHECK(a.variables[1].name == "r2");
  CHECK(a.variables[1].start == 9);
  CHECK(a.variables[1].step == 1);
  const Scene b = read_scene(data + "/paper/start_b.toml"), c = read_scene(data + "/paper/start_c.toml");
  CHECK(b.variables[0].start == 1.8);
  CHECK(b.variables[1].start == 7);
  CHECK(c.variables[0].start == std::sqrt(0.5));
  CHECK(c.variables[1].start == 5);
  const Scene p = read_scene(data + "/paper/paraboloid.toml");
  CHECK(start_profile(p).points() == std::vector<ControlPoint>{{0, 100, 1}, {50, 100, 1}, {100, 50, 1}});
}

TEST_CASE("the paper's target is 2 W/m^2 at the centre and follows eq. 12 and 13") {
  const Scene a = read_scene(data + "/paper/start_a.toml");
  const double power = a.source.power_w;
  CHECK(to_w_per_m2(paraboloid_reflected_w_per_mm2(power, 50, 100, 0)) == Approx(1).epsilon(1e-14));
  CHECK(to_w_per_m2(paraboloid_direct_w_per_mm2(power, 50, 0)) == Approx(1).epsilon(1e-14));
  CHECK(to_w_per_m2(paraboloid_reflected_w_per_mm2(power, 50, 100, 100)) == Approx(0.25).epsilon(1e-14));
  CHECK(paraboloid_reflected_w_per_mm2(power, 50, 100, 100.001) == 0);
  CHECK(to_w_per_m2(paraboloid_direct_w_per_mm2(power, 50, 50)) == Approx(std::pow(2, -1.5)).epsilon(1e-14));
  const Target target = make_target(a);
  REQUIRE(target.samples.size() == 512);
  for (std::size_t i = 0; i < target.samples.size(); i += 37) {
    const double p = std::hypot(target.samples[i].point_mm.x(), target.samples[i].point_mm.y());
    const double q = p * p / 2500;
    const double expected = 1 / ((1 + q / 4) * (1 + q / 4)) + std::pow(1 + q, -1.5);
    CHECK(to_w_per_m2(target.irradiance_w_per_mm2[i]) == Approx(expected).epsilon(1e-13));
  }
}

TEST_CASE("a scene written out reads back as the same scene, bit for bit") {
  for (const char* name : {"/paper/start_a.toml", "/paper/start_c.toml"}) {
    const Scene first = read_scene(data + name);
    const std::string written = scene_text(first);
    const Scene second = make_scene(Settings::parse(written, "scene.toml", scene_keys()));
    CHECK(scene_text(second) == written);
    CHECK(first.profile == second.profile);
    CHECK(first.source.power_w == second.source.power_w);
    CHECK(first.variables[0].start == second.variables[0].start);
    CHECK(first.model.estimate.kernel_radius_mm == second.model.estimate.kernel_radius_mm);
  }
  const Scene odd = scene(text("", "title = \"a \\\"quoted\\\" \\\\ back\\tslash\"\nunit = \"in\"\n"));
  const Scene again = make_scene(Settings::parse(scene_text(odd), "s", scene_keys()));
  CHECK(again.title == odd.title);
}

TEST_CASE("what a scene leaves out has defaults, and they are written out") {
  const Scene plain = scene(text());
  const std::string written = scene_text(plain);
  CHECK(plain.model.estimate.kernel_radius_mm == 5.0);
  CHECK(plain.model.photons.photons == 100000);
  for (const char* key : {"kernel_radius = 0.5", "photons = 100000", "kind = \"none\"",
                          "weights = [1.0, 1.0, 1.0]", "[export]"}) {
    INFO(key);
    CHECK(written.find(key) != std::string::npos);
  }
}

TEST_CASE("scenes that contradict themselves are refused with the key and its line") {
  refused("unit = \"cm\"\n[reflector]\npoints = [[0, 1], [1, 0]]\n[near_field]\nradius = 1\n",
          "source.power");
  refused("[source]\npower = 1\n[near_field]\nradius = 1\n", "reflector.points");
  refused("[source]\npower = 1\n[reflector]\npoints = [[0, 1], [1, 0]]\n", "near_field.radius");
  refused(text("width = 3\n"), "near_field.width");
  refused(text("reflectance = 0.5\n"), "invisible");
  refused(text("normal = [0, 0, 0]\n"), "no direction");
  refused(text("[model]\nneighbours = 100\nkernel_radius = 1\n"), "two bandwidths");
  refused(text("[target]\nkind = \"paraboloid\"\n"), "target.focal_length");
  refused(text("[target]\nkind = \"csv\"\n"), "target.file");
  refused(text("[target]\nkind = \"reflector\"\n"), "target.points");
  refused(text("[variables.w1]\nstep = 1\nlower = 0.1\n"), "variables.w1.upper");
  refused(text("[variables.w1]\nstep = 1\nlower = 3\nupper = 2\n"), "bounds leave no room");
  refused(text("[variables.w1]\nstep = 1\nlower = 2\nupper = 3\n"), "outside [2, 3]");
  refused(text("[variables.w1]\nstep = 1\nlower = -1\nupper = 3\n"), "no lower bound for a weight");
  refused(text("[variables.w9]\nstep = 1\nlower = 0.1\nupper = 3\n"), "no variable of this reflector");
  refused(text("[landscape]\nvariables = [\"w1\", \"w1\"]\nlower = [1, 1]\nupper = [2, 2]\nsteps = [3, 3]\n"),
          "two different");
  refused(text("[landscape]\nvariables = [\"w1\"]\nlower = [1, 1]\nupper = [2]\nsteps = [3]\n"),
          "landscape.lower");
  refused(text("[landscape]\npaths = true\n"), "landscape.paths");
  const std::string
      drawn = "[landscape]\nvariables = [\"w1\", \"r2\"]\nlower = [1, 5]\nupper = [2, 12]\nsteps = [2, 2]\n",
      moved =
          "[variables.w1]\nstep = 1\nlower = 0.1\nupper = 3\n[variables.r2]\nstep = 1\nlower = 1\nupper = "
          "20\n";
  refused(text(drawn + "paths = true\n[variables.w1]\nstep = 1\nlower = 0.1\nupper = 3\n"),
          "r2 is not searched");
  refused(text(drawn + "starts = [[1, 7]]\n" + moved), "no paths are drawn");
  refused(text(drawn + "paths = true\nstarts = [[1, 7], [3.5, 7]]\n" + moved), "w1 = 3.5 lies outside");
  refused(text(drawn + "paths = true\n[search]\nfree = \"profile\"\nrefine = [\"degree 3\"]\n"),
          "landscape.paths");
  refused(text("[landscape]\nvariables = [\"w1\"]\nlower = [1]\nupper = [2]\nsteps = [3]\npaths = "
               "true\nstarts = [[1, 7]]\n" +
               moved),
          "starts are pairs");
  CHECK(scene(text(drawn + "paths = true\nstarts = [[1, 7]]\n" + moved)).landscape->starts.size() == 1);
  refused(
      "[source]\npower = 1\n[reflector]\npoints = [[0, 1], [1, 0]]\nweights = [1]\n[near_field]\nradius = "
      "1\n",
      "1 weights for 2 points");
  refused("[source]\npower = 1\n[reflector]\npoints = [[0, 1], [2, 1], [-1, 0]]\n[near_field]\nradius = 1\n",
          "crosses the axis");
  refused(
      "[source]\npower = 1\n[reflector]\npoints = [[0, 1], [1, 0]]\nreflectance = 0.7\ntransmittance = "
      "0.4\n[near_field]\nradius = 1\n",
      "more light leaves");
  refused(
      "[source]\npower = 1\nposition = [1, 0, 5]\n[reflector]\npoints = [[0, 10], [5, 10], [10, "
      "5]]\n[near_field]\nradius = 1\n[target]\nkind = \"paraboloid\"\nfocal_length = 5\n",
      "do not hold");
  refused(
      "[source]\npower = 1\n[reflector]\npoints = [[0, 1], [1, 0]]\n[near_field]\nshape = "
      "\"rectangle\"\nwidth = 1\nheight = 1\nalong = [0, 0, 2]\n",
      "parallel to the normal");
}

TEST_CASE("what cannot be searched or aimed at is said before anything runs") {
  const RunControl control;
  CHECK_THROWS_WITH(run_design(scene(text()), control), Catch::Contains("nothing to search"));
  CHECK_THROWS_WITH(run_design(scene(text("[variables.w1]\nstep = 1\nlower = 0.1\nupper = 3\n")), control),
                    Catch::Contains("nothing to aim at"));
  CHECK_THROWS_WITH(
      run_landscape(scene(text("[target]\nkind = \"paraboloid\"\nfocal_length = 5\n")), control),
      Catch::Contains("landscape.variables"));
}

TEST_CASE("a landscape's paths are those that the search takes from each start", "[long]") {
  for (const char* method : {"hooke-jeeves", "nelder-mead"}) {
    INFO(method);
    const std::vector<Override> small{{"landscape.steps", "[2, 2]", "test"},
                                      {"landscape.paths", "true", "test"},
                                      {"landscape.starts", "[[1.1, 9.5]]", "test"},
                                      {"search.most_evaluations", "300", "test"},
                                      {"search.method", "\"" + std::string(method) + "\"", "test"}};
    const Scene drawn = read_scene(data + "/paper/start_a.toml", small);
    const std::vector<SearchPath> paths = run_landscape(drawn, {}).paths;
    REQUIRE(paths.size() == 2);
    CHECK(paths[0].name == "A");
    CHECK(paths[0].points.front() == std::vector<double>{1.6, 9});
    CHECK(paths[1].points.front() == std::vector<double>{1.1, 9.5});
    const DesignResult alone = run_design(drawn, {});
    CHECK(paths[0].points.back() == alone.search.best);
    CHECK(paths[0].values.back() == alone.search.value);
    for (const SearchPath& path : paths) {
      REQUIRE(path.values.size() == path.points.size());
      CHECK(std::is_sorted(path.values.rbegin(), path.values.rend()));
      CHECK(path.points.back()[0] == Approx(1).margin(0.05));
      CHECK(path.points.back()[1] == Approx(10).margin(0.05));
    }
  }
}

TEST_CASE("a generatrix from an IGES file is placed, turned and written out as the scene's own") {
  const std::string head =
      "unit = \"cm\"\n[source]\nposition = [0, 0, 5]\npower = 1\n[near_field]\nradius = 5\n[reflector]\n";
  const auto from = [&](const std::string& more) {
    return make_scene(Settings::parse(head + more, data + "/paper/x.toml", scene_keys()));
  };
  const Scene plain = from("profile = \"../profiles/start_a.igs\"\n");
  CHECK(plain.profile.points() == std::vector<ControlPoint>{{0, 100, 1}, {50, 100, 1.6}, {90, 50, 1}});
  CHECK_FALSE(plain.profile_notes.empty());
  const Scene again = make_scene(Settings::parse(scene_text(plain), "elsewhere/scene.toml", scene_keys()));
  CHECK(again.profile == plain.profile);

  const Scene tilted = from("profile = \"../profiles/start_a_tilted.igs\"\nprofile_apex = 10\n");
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(tilted.profile.points()[i].r_mm == Approx(plain.profile.points()[i].r_mm).margin(1e-12));
    CHECK(tilted.profile.points()[i].z_mm == Approx(plain.profile.points()[i].z_mm).epsilon(1e-13));
  }
  const Scene turned = from("profile = \"../profiles/start_a.igs\"\nprofile_upside_down = true\n");
  CHECK(turned.profile.points()[2].z_mm == -50);
  CHECK_THROWS_WITH(from("profile = \"../profiles/start_a.igs\"\ndegree = 3\n"),
                    Catch::Contains("described twice"));
  CHECK_THROWS_AS(from("profile = \"../profiles/none.igs\"\n"), CadError);
}
