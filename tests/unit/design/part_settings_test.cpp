#include "design/part_settings.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "cad/opening.h"
#include "design/designed_scene.h"
#include "design/evaluator.h"
#include "design/run.h"
#include "design/sampling.h"
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

TEST_CASE("keys of the part are what files are to hold") {
  const cad::ExportOptions plain = scene("").export_options;
  CHECK(!plain.wall);
  CHECK(plain.material.name.empty());
  CHECK(plain.dxf_curves == cad::DxfCurves::automatic);
  const cad::ExportOptions part = scene("wall = 1.5\nflange = 8\nmaterial = \"Steel\"\ndensity = 7850",
                                        "[export]\ndxf_curves = \"splines\"")
                                      .export_options;
  REQUIRE(part.wall);
  CHECK(part.wall->thickness_mm == 1.5);
  REQUIRE(part.wall->flange);
  CHECK(part.wall->flange->width_mm == 8);
  CHECK(part.wall->flange->thickness_mm == 1.5);  // the wall's
  CHECK(part.material.name == "Steel");
  CHECK(part.material.density_kg_per_m3 == 7850);
  CHECK(part.dxf_curves == cad::DxfCurves::splines);
  CHECK(scene("wall = 1\nflange = 8\nflange_thickness = 3").export_options.wall->flange->thickness_mm == 3);
}

TEST_CASE("keys of the part that say nothing by themselves are refused with their names") {
  refused("flange = 5", "reflector.flange", "stands alone");
  refused("wall = 1\nflange_thickness = 2", "reflector.flange_thickness", "stands alone");
  refused("wall_side = \"inside\"", "reflector.wall_side", "stands alone");
  refused("material = \"Steel\"", "reflector.material", "stands alone");
  refused("wall = 1\nwall_side = \"inside\"\nflange = 5", "reflector.flange", "no place");
  refused("wall = 1\nflange = 0.3", "reflector.flange", "within the wall");
  refused("wall = 1\nflange = 8\nflange_thickness = 60", "reflector.flange", "does not fit");
  refused("opening = 100", "reflector.opening", "cannot be cut");
  refused("opening = 0", "reflector.opening", "0");
  refused("opening = 10", "reflector.opening", "Levenberg", "[search]\nmethod = \"levenberg-marquardt\"");
  CHECK_THROWS_WITH(read_scene(std::string(CATOPTRIC_DATA) + "/examples/gaussian_spot.toml",
                               {{"reflector.opening", "5", "test"}}),
                    Catch::Contains("reflector.opening") && Catch::Contains("tailor"));
}

TEST_CASE("an opening is cut from every mirror of the scene, and variables stay those of the whole mirror") {
  const std::string variables =
      "[variables.r2]\nstep = 1\nlower = 8\nupper = 200\n[variables.w1]\nstart = 1.3\nstep = 0.1\nlower = "
      "0.1\nupper = 10\n";
  const Scene whole = scene("", variables), opened = scene("opening = 10", variables);
  CHECK(start_profile(opened) == cad::with_opening(start_profile(whole), 10));
  const SceneFamily family = family_of(opened);
  const std::vector<double> values{2, 80};  // w1, r2
  REQUIRE(family.at(values));
  CHECK(family.at(values)->profile == cad::with_opening(family_of(whole).at(values)->profile, 10));
  CHECK(family.whole_at(values)->profile == family_of(whole).at(values)->profile);
  CHECK(!family.at(std::vector<double>{1, 9}));  // a mirror that lies within its opening is none
}

TEST_CASE("a designed mirror with an opening is read back with the same opening") {
  const Scene opened = scene("opening = 10");
  const Judged found{start_profile(opened), {}, {}, {}, opened.source, {}};
  const Scene again = make_scene(Settings::parse(designed_text(opened, found), "d.toml", scene_keys()));
  CHECK(again.profile == found.profile);
  CHECK(start_profile(again) == found.profile);  // nothing is cut twice
}

TEST_CASE("no light comes back from an opening, and the rest of the field stays: tubes and photons") {
  // A paraboloid sends its light down parallel to the axis: what comes back at r was reflected at r.
  const std::string model = "samples = 200\n[model]\nkernel_radius = 2\nphotons = 100000\n";
  const Scene whole = scene("", model), opened = scene("opening = 20", model);
  const auto samples = field_samples(opened);
  for (const sim::Rung rung : {sim::Rung::tubes, sim::Rung::photons}) {
    const Evaluation before = evaluate_by_rung(whole, rung, start_profile(whole), samples, 1);
    const Evaluation after = evaluate_by_rung(opened, rung, start_profile(opened), samples, 1);
    // 100,000 photons over a beam of 100 mm, a kernel of 2 mm: 40 in it, which is 16 % of noise at one sigma.
    // Tubes are asked for 2.5e-7 of the field.
    const double noise = rung == sim::Rung::tubes ? 1e-6 : 1;
    int inside = 0, outside = 0;
    double mean_before = 0, mean_after = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const double r_mm = std::hypot(samples[i].point_mm.x(), samples[i].point_mm.y());
      CHECK(after.direct[i] == before.direct[i]);
      if (r_mm < 18) {
        ++inside;
        CHECK(after.reflected[i] == 0);
        CHECK(before.reflected[i] > 0);
      } else if (r_mm > 22) {
        ++outside;
        CHECK(after.reflected[i] == Approx(before.reflected[i]).epsilon(noise));
        mean_before += before.reflected[i];
        mean_after += after.reflected[i];
      }
    }
    CHECK(inside > 10);
    CHECK(outside > 100);
    CHECK(mean_after == Approx(mean_before).epsilon(rung == sim::Rung::tubes ? 1e-6 : 0.02));
  }
}
