#include "design/surroundings_settings.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "base/units.h"
#include "cad/export.h"
#include "design/evaluator.h"
#include "design/field_targets.h"
#include "design/judge.h"
#include "design/metrics.h"
#include "design/run.h"
#include "design/scene.h"
#include "design/target.h"
#include "sim/fresnel.h"
#include "support/temporary_folder.h"

using namespace catoptric;
using namespace catoptric::design;

namespace {

std::string text(const std::string& more, const std::string& reflectance = "0.9") {
  return "unit = \"cm\"\n[source]\nposition = [0, 0, 5]\npower = 3\n"
         "[reflector]\npoints = [[0, 10], [5, 10], [10, 5]]\nreflectance = " +
         reflectance +
         "\n"
         "[near_field]\nradius = 5\nsamples = 64\n[model]\nphotons = 20000\nkernel_radius = 1\n" +
         more;
}

Scene scene(const std::string& more, const std::string& reflectance = "0.9") {
  return make_scene(Settings::parse(text(more, reflectance), "s.toml", scene_keys()));
}

void refused(const std::string& more, const std::string& part) {
  INFO(more);
  CHECK_THROWS_WITH(scene(more), Catch::Contains(part));
}

struct Plate {
  double thickness_mm, index;
};

/// What a plate lets through at an incidence, all reflections inside counted.
double through(double sine, const Plate& plate) {
  const sim::PolarisedReflectance one = sim::polarised_reflectance(std::sqrt(1 - sine * sine), plate.index);
  return 0.5 * ((1 - one.across) / (1 + one.across) + (1 - one.along) / (1 + one.along));
}

/// Relative irradiance of a point 50 mm above a plane, under a plate in between.
double lit(double radius_mm, const Plate& plate) {
  const auto lands = [&](double angle) {
    return (50 - plate.thickness_mm) * std::tan(angle) +
           plate.thickness_mm * std::tan(std::asin(std::sin(angle) / plate.index));
  };
  double low = 0, high = 1.5;
  for (int i = 0; i < 60; ++i) (lands(0.5 * (low + high)) < radius_mm ? low : high) = 0.5 * (low + high);
  constexpr double step = 1e-5;
  const double slope = (lands(low + step) - lands(low - step)) / (2 * step);
  const double share = plate.thickness_mm > 0 ? through(std::sin(low), plate) : 1;
  return share * std::sin(low) / (radius_mm * slope);
}

const std::string wall =
    "[fields.wall]\ncenter = [8, 0, 3]\nnormal = [-1, 0, 0]\nwidth = 6\nheight = 4\nsamples = 24\n";

}  // namespace

TEST_CASE("things and fields are read in the scene's unit, and written out with what was left out") {
  const Scene read =
      scene(wall +
            "[objects.cover]\nkind = \"pane\"\nradius = 11\nthickness = 0.3\ncenter = [0, 0, 1]\n"
            "index = 1.5\nabsorption = 0.1\n"
            "[objects.stop]\nkind = \"disc\"\nradius = 2\ninner_radius = 1\nbelongs = \"room\"\n");
  REQUIRE(read.surroundings);
  REQUIRE(read.surroundings->objects().size() == 2);
  const sim::Object& cover = read.surroundings->objects()[0];
  CHECK(cover.name == "cover");
  CHECK(cover.glass == sim::Glass{1.5, 0.01});
  CHECK(cover.of_luminaire);
  const auto front = cover.faces[0]->meet({{0, 0, 100}, {0, 0, -1}}, false, 1e9);
  REQUIRE(front);
  CHECK(front->distance_mm == Approx(100 - 11.5).epsilon(1e-15));
  CHECK_FALSE(read.surroundings->objects()[1].of_luminaire);
  CHECK_FALSE(read.surroundings->objects()[1].faces[0]->meet({{5, 0, 100}, {0, 0, -1}}, false, 1e9));
  CHECK(read.surroundings->objects()[1].faces[0]->meet({{15, 0, 100}, {0, 0, -1}}, false, 1e9));
  CHECK(read.surroundings->fields()[0].field.half_width_mm() == 30);
  CHECK(read.surroundings->fields()[0].kernel_scale == Approx(0.2).epsilon(1e-15));
  CHECK(read.surroundings->luminaire().objects().size() == 1);
  const std::string written = scene_text(read);
  CHECK(scene_text(scene("[objects.\"a b.c\"]\nkind = \"disc\"\nradius = 1\n")).find("[objects.\"a b.c\"]") !=
        std::string::npos);
  CHECK(scene_text(make_scene(Settings::parse(written, "again.toml", scene_keys()))) == written);
  CHECK_THAT(written, Catch::Contains("belongs = \"luminaire\"") && Catch::Contains("kernel_radius = 0.2"));
}

TEST_CASE("samples of further fields count by their area and their weight, and not where nothing is wanted") {
  const Scene plain = scene(wall + "[target]\nkind = \"uniform\"\nradius = 5\nirradiance = 2\n");
  const Target target = make_target(plain);
  REQUIRE(target.samples.size() == 88);
  CHECK(target.weights[0] == 1);
  CHECK(target.weights[70] == 0);
  const Scene wanted = scene(wall +
                             "irradiance = 3\nweight = 2\n[target]\nkind = \"uniform\"\nradius = 5\n"
                             "irradiance = 2\n");
  const Target both = make_target(wanted);
  CHECK(both.irradiance_w_per_mm2[70] == Approx(3e-6));
  CHECK(both.weights[70] == Approx(2 * (24.0 / 24) / (25 * pi / 64)).epsilon(1e-14));
  CHECK(both.areas_mm2[70] == Approx(100).epsilon(1e-14));
  // All light on both fields over the source's: by the areas of each.
  std::vector<double> light(88, 1e-6);
  for (std::size_t i = 64; i < 88; ++i) light[i] = 2e-6;
  CHECK(*metric_value(Metric::efficiency, wanted, light, both) ==
        Approx((1e-6 * 2500 * pi + 2e-6 * 2400) / 3).epsilon(1e-12));
  const Target alone = near_field_alone(both);
  CHECK(alone.samples.size() == 64);
  const Scene only_wall = scene(wall + "irradiance = 3\n");
  const Target on_wall = make_target(only_wall);
  CHECK(on_wall.weights[0] == 0);
  CHECK(on_wall.weights[70] > 0);
}

TEST_CASE("a paraboloid seen through the kernel leaves further fields what is wanted of them") {
  const Scene read = scene(wall + "irradiance = 3\n[target]\nkind = \"paraboloid\"\nfocal_length = 5\n");
  const Target plain = make_target(read), blurred = blurred_target(read);
  REQUIRE(blurred.irradiance_w_per_mm2.size() == plain.irradiance_w_per_mm2.size());
  CHECK(blurred.irradiance_w_per_mm2[0] != plain.irradiance_w_per_mm2[0]);
  for (std::size_t i = 64; i < 88; ++i)
    CHECK(blurred.irradiance_w_per_mm2[i] == plain.irradiance_w_per_mm2[i]);
}

TEST_CASE("a scene with things about takes rings where they are round, and says of each what it does") {
  const auto plan_with = [](const std::string& center) {
    const Scene covered =
        scene("[objects.cover]\nkind = \"pane\"\nradius = 20\nthickness = 0.3\ncenter = " + center +
              "\nindex = 1.5\n");
    return make_plan(covered, covered.profile);
  };
  CHECK(plan_with("[0.1, 0, 1]").rung == sim::Rung::photons);
  const sim::Plan plan = plan_with("[0, 0, 1]");
  CHECK(plan.rung == sim::Rung::rings);
  std::string said;
  for (const sim::Finding& finding : plan.findings)
    said += finding.feature + "|" + finding.found + "|" + finding.consequence + "\n";
  CHECK_THAT(said, Catch::Contains("cover|glass of index 1.5") && Catch::Contains("photons bring it too") &&
                       Catch::Contains("other things stand about"));
}

TEST_CASE("a cover costs the light that Fresnel says, and what it throws back the mirror sends down again",
          "[long]") {
  const std::string cover =
      "[objects.cover]\nkind = \"pane\"\nradius = 1000\nthickness = 0.3\ncenter = [0, 0, 1]\n"
      "index = 1.5\n";
  const auto total = [](Scene read) {
    read.model.photons.photons = 1'000'000;
    const Evaluation found =
        evaluate_by_rung(read, sim::Rung::photons, read.profile, read.near_field.samples(64), 1);
    double sum = 0;
    for (std::size_t i = 0; i < 64; ++i) sum += found.direct[i] + found.reflected[i];
    return sum;
  };
  // Light straight from the source goes through a plate that takes its share and shifts it inwards.
  double wanted = 0, clear = 0;
  for (const sim::FieldSample& sample : scene("").near_field.samples(64)) {
    const double radius_mm = sample.point_mm.head<2>().norm();
    clear += lit(radius_mm, {0, 1.5});
    wanted += lit(radius_mm, {3, 1.5});
  }
  const double direct = total(scene(cover, "0.0")) / total(scene("", "0.0"));
  CHECK(direct ==
        Approx(wanted / clear).epsilon(0.006));  // three times its noise, and the kernel's bias at the rim
  // Upright light of the mirror goes back to it by a twelfth, and some of that comes down within the field.
  const double all = total(scene(cover)) / total(scene(""));
  CHECK(all > 0.95);
  CHECK(all < 1.05);
}

TEST_CASE("the faces of a file are a field like the shape they have", "[long]") {
  const test::TemporaryFolder folder;
  const auto file = folder / "tube.step";
  cad::export_reflector(Profile(1, {0, 0, 1, 1}, {{70, -40, 1}, {70, 20, 1}}), file);
  const std::string size = "samples = 300\nkernel_radius = 1\n",
                    tube = "shape = \"cylinder\"\nradius = 7\nlength = 6\ncenter = [0, 0, -1]\n" + size,
                    faces = "shape = \"file\"\nchord_error = 1e-4\nfile = '" + file.string() + "'\n" + size;
  std::string all =
      text("[fields.a]\n" + tube + "lit = \"inside\"\n[fields.b]\n" + faces + "lit = \"back\"\n[fields.c]\n" +
           faces + "lit = \"front\"\n[fields.d]\n" + tube + "lit = \"outside\"\n");
  const std::string focus = "position = [0, 0, 5]";
  all.replace(all.find(focus), focus.size(),
              "position = [0, 0, 4]");  // else reflected light is parallel to them
  const Scene read = make_scene(Settings::parse(all, "s.toml", scene_keys()));
  const std::vector<FurtherFigures> found =
      judge(read, make_target(read), read.profile, sim::Rung::photons, 1).further;
  REQUIRE(found.size() == 4);
  const auto flux = [&](std::size_t i) { return found[i].figures.flux_w->value; };
  CHECK(flux(0) > 0.1);
  CHECK(flux(3) > 0.02);
  CHECK(flux(1) == Approx(flux(0)).epsilon(0.02));
  CHECK(flux(2) == Approx(flux(3)).epsilon(0.02));
  CHECK(found[1].spacing_mm == Approx(std::sqrt(2 * pi * 70 * 60 / 300)).epsilon(1e-3));
}

TEST_CASE("things that make no sense are refused by their keys") {
  refused("[objects.a]\nradius = 1\n", "objects.a.kind: is missing");
  refused("[objects.a]\nkind = \"disc\"\n", "objects.a.radius: is missing");
  refused("[objects.a]\nkind = \"disc\"\nradius = 1\nlength = 2\n",
          "objects.a.length: does not belong to a disc");
  refused("[objects.a]\nkind = \"disc\"\nradius = 1\ninner_radius = 1\n", "objects.a.inner_radius");
  refused("[objects.a]\nkind = \"disc\"\nradius = 1\nindex = 1.5\n", "objects.a.index: has no effect");
  refused("[objects.a]\nkind = \"disc\"\nradius = 1\nreflectance = 0.7\ntransmittance = 0.5\n",
          "more light leaves than arrives");
  refused("[objects.a]\nkind = \"pane\"\nradius = 1\nthickness = 0.1\n", "objects.a.index: is missing");
  refused("[objects.a]\nkind = \"pane\"\nthickness = 0.1\nindex = 1.5\n", "does not settle the pane's shape");
  refused("[objects.a]\nkind = \"pane\"\nradius = 1\nthickness = 0.1\nindex = 1.5\nreflectance = 0.1\n",
          "objects.a.reflectance: has no effect");
  refused("[objects.a]\nkind = \"dome\"\nradius = 1\nthickness = 1\nindex = 1.5\n", "a dome is hollow");
  refused("[objects.a]\nkind = \"sphere\"\nradius = 1\nnormal = [0, 0, 1]\n", "a whole sphere looks alike");
  refused("[objects.a]\nkind = \"disc\"\nradius = 1\nnormal = [0, 0, 0]\n", "has no direction");
  refused("[fields.a]\nwidth = 1\n", "fields.a.height: is missing");
  refused("[fields.a]\nwidth = 1\nheight = 1\nreflectance = 0.5\n", "an invisible field has no material");
  refused("[fields.a]\nwidth = 1\nheight = 1\nweight = 2\n", "fields.a.weight: stands alone");
  refused("[fields.a]\nwidth = 1\nheight = 1\nalong = [0, 0, 1]\n", "is parallel to the normal");
  refused("[fields.a]\nshape = \"cylinder\"\nradius = 1\nlength = 9\nkernel_radius = 4\n",
          "more than once round");
  refused("[fields.a]\nshape = \"file\"\n", "fields.a.file: is missing");
  refused("[fields.a]\nshape = \"file\"\nfile = \"a.step\"\n", "fields.a.kernel_radius: is missing");
  refused("[fields.a]\nshape = \"file\"\nfile = \"a.step\"\nkernel_radius = 1\n", "a.step");
  refused("[fields.a]\nshape = \"file\"\nfile = \"a.step\"\nlit = \"inside\"\n", "is no side of this shape");
  refused("[fields.a]\nshape = \"cylinder\"\nradius = 1\nlength = 9\nlit = \"back\"\n",
          "is no side of this shape");
  refused("[fields.a]\nwidth = 1\nheight = 1\nfile = \"a.step\"\n", "does not belong to a rectangle");
  CHECK_THROWS_WITH(make_scene(Settings::parse("accuracy = 0.01\n" + text(wall), "s.toml", scene_keys())),
                    Catch::Contains("proven for the near field alone"));
}
