#include "design/picture.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "design/metrics.h"
#include "design/scene.h"
#include "design/target.h"
#include "support/pfm_bytes.h"
#include "support/png_bytes.h"
#include "support/temporary_folder.h"

using namespace catoptric;
using namespace catoptric::design;
using namespace catoptric::test;

namespace {

/// A near field of 80 mm x 60 mm about (10, 20, -100), whose first axis is y, so that its second one is -x.
std::string scene_text_of(const std::string& target) {
  return "[source]\nposition = [0, 0, 5]\npower = 1\n[reflector]\npoints = [[0, 10], [5, 10], [10, 5]]\n"
         "[near_field]\nshape = \"rectangle\"\ncenter = [10, 20, -100]\nalong = [0, 1, 0]\nwidth = 80\n"
         "height = 60\nsamples = 48\n[target]\nkind = \"image\"\n" +
         target;
}

Scene scene(const std::string& target) {
  return make_scene(Settings::parse(scene_text_of(target), "s.toml", scene_keys()));
}

std::string in(const TemporaryFolder& folder, const std::string& name) {
  return "file = '" + (folder / name).string() + "'\n";
}

/// A picture of 2 rows and 3 columns: 1 2 3 over 4 5 6 W/m^2, 30 mm by 20 mm.
Picture six_pixels() { return {3, 2, {1, 2, 3, 4, 5, 6}, 30, 20}; }

/// Values of a function of the plane at the centres of many pixels, on a square.
template <typename Function>
Picture drawn(double side_mm, Function&& function) {
  constexpr std::size_t count = 400;
  Picture picture{count, count, {}, side_mm, side_mm};
  for (std::size_t row = 0; row < count; ++row)
    for (std::size_t column = 0; column < count; ++column)
      picture.irradiance_w_per_mm2.push_back(
          function(side_mm * ((static_cast<double>(column) + 0.5) / count - 0.5),
                   side_mm * (0.5 - (static_cast<double>(row) + 0.5) / count)));
  return picture;
}

}  // namespace

TEST_CASE("a picture is bilinear between its pixels' centres, level at the edge and dark beyond") {
  const Picture picture = six_pixels();
  CHECK(picture.at({-10, 5}) == Approx(1));  // first row: greatest second coordinate
  CHECK(picture.at({10, 5}) == Approx(3));
  CHECK(picture.at({-10, -5}) == Approx(4));
  CHECK(picture.at({10, -5}) == Approx(6));
  CHECK(picture.at({0, 0}) == Approx(3.5));
  CHECK(picture.at({-7.5, 5}) == Approx(1.25));
  CHECK(picture.at({-7.5, 2.5}) == Approx(1.25 + 3 * 0.25));
  CHECK(picture.at({15, 10}) == Approx(3));
  CHECK(picture.at({-15, -10}) == Approx(4));
  CHECK(picture.at({15.001, 0}) == 0);
  CHECK(picture.at({0, -10.001}) == 0);
  CHECK(Picture{1, 1, {7}, 2, 2}.at({0.9, -0.3}) == 7);
}

TEST_CASE("a picture lies about the near field's centre, rows along its first axis, and is wanted there") {
  const TemporaryFolder folder;
  write_whole(folder / "p.pgm", "P2 2 1 4\n1 4\n");
  const Scene spec = scene(in(folder, "p.pgm") + "width = 60\npeak = 8\n");
  CHECK(spec.target.picture->width_mm == 60);
  CHECK(spec.target.picture->height_mm == 30);
  const Target target = make_target(spec);
  REQUIRE(target.samples.size() == 48);
  int lit = 0;
  for (std::size_t i = 0; i < target.samples.size(); ++i) {
    const double along = target.samples[i].point_mm.y() - 20, across = target.samples[i].point_mm.x() - 10;
    INFO(along << " " << across);
    const bool inside = std::abs(along) <= 30 && std::abs(across) <= 15;
    const double share = std::min(1.0, std::max(0.0, along / 30 + 0.5));  // from the left pixel's centre
    CHECK(to_w_per_m2(target.irradiance_w_per_mm2[i]) == Approx(inside ? 2 + 6 * share : 0).margin(1e-12));
    CHECK(target.within_reach[i] == (inside ? 1 : 0));
    lit += target.lit[i];
  }
  CHECK(lit == std::count(target.within_reach.begin(), target.within_reach.end(), 1));
  CHECK(lit > 10);
  // the greatest second coordinate, which is the least x, has the first row
  write_whole(folder / "q.pgm", "P2 1 2 4\n4 1\n");
  const Scene turned = scene(in(folder, "q.pgm") + "height = 60\npeak = 4\n");
  const Vector2 top = turned.near_field.to_plane({10 - 20, 20, -100});
  CHECK(to_w_per_m2(turned.target.picture->at(top)) == Approx(4));
}

TEST_CASE("grey stands for irradiance as the file or the scene says, and scene.toml says it too") {
  const TemporaryFolder folder;
  const std::string half(1, static_cast<char>(128)), white(1, static_cast<char>(255));
  write_whole(folder / "silent.png", grey_png({half + white}));
  write_whole(folder / "srgb.png",
              PngBytes(2, 1, 8, 0).chunk("sRGB", std::string(1, '\0')).with_rows({half + white}));
  write_whole(folder / "gamma.png",
              PngBytes(2, 1, 8, 0).chunk("gAMA", std::string("\0\0\xC3\x50", 4)).with_rows({half + white}));
  const auto light = [&](const std::string& file, const std::string& more = "") {
    const Scene spec = scene(in(folder, file) + "width = 60\npeak = 10\n" + more);
    const Scene again = written_scene(Settings::parse(scene_text(spec), "again.toml", scene_keys()));
    CHECK(scene_text(again) == scene_text(spec));
    CHECK(again.target.picture->irradiance_w_per_mm2 == spec.target.picture->irradiance_w_per_mm2);
    CHECK(again.target.picture->height_mm == spec.target.picture->height_mm);
    CHECK(again.target.notes == spec.target.notes);
    CHECK(to_w_per_m2(spec.target.picture->irradiance_w_per_mm2[1]) == Approx(10));
    return to_w_per_m2(spec.target.picture->irradiance_w_per_mm2[0]);
  };
  const double grey = 128.0 / 255, srgb = std::pow((grey + 0.055) / 1.055, 2.4);
  CHECK(light("silent.png") == Approx(10 * grey));
  CHECK(light("srgb.png") == Approx(10 * srgb));
  CHECK(light("srgb.png") == Approx(2.1586).epsilon(1e-4));  // the table's value of 128
  CHECK(light("gamma.png") == Approx(10 * grey * grey));     // 50000: light goes like its square
  CHECK(light("srgb.png", "transfer = \"linear\"\n") == Approx(10 * grey));
  CHECK(light("silent.png", "transfer = \"srgb\"\n") == Approx(10 * srgb));
  CHECK(light("silent.png", "gamma = 3\n") == Approx(10 * std::pow(grey, 3)));
  CHECK(light("silent.png", "gamma = 1\n") == Approx(10 * grey));
}

TEST_CASE("a PFM holds irradiance itself, unless a peak is given") {
  const TemporaryFolder folder;
  write_whole(folder / "p.pfm", pfm_bytes({{3, 6}}, "-1.0"));
  const auto values = [&](const std::string& more) {
    std::vector<double> list =
        scene(in(folder, "p.pfm") + "width = 60\n" + more).target.picture->irradiance_w_per_mm2;
    for (double& each : list) each = to_w_per_m2(each);
    return list;
  };
  CHECK(values("")[0] == Approx(3));
  CHECK(values("")[1] == Approx(6));
  CHECK(values("peak = 2\n")[0] == Approx(1));
  CHECK(values("peak = 2\n")[1] == Approx(2));
  CHECK(values("scale = \"free\"\n")[1] == Approx(6));
}

TEST_CASE("of a picture of free scale only the shape counts") {
  const TemporaryFolder folder;
  write_whole(folder / "p.pgm", "P2 2 1 4\n1 4\n");
  Scene spec =
      scene(in(folder, "p.pgm") + "width = 90\nscale = \"free\"\n[search]\nmetric = \"relative-rmse\"\n");
  const Target target = make_target(spec);
  std::vector<double> field = target.irradiance_w_per_mm2;
  for (double& each : field) each *= 123;
  CHECK(*metric_value(Metric::relative_rmse, spec, field, target) == Approx(0).margin(1e-12));
  *std::max_element(field.begin(), field.end()) *= 2;
  CHECK(*metric_value(Metric::relative_rmse, spec, field, target) > 0.01);
}

TEST_CASE("pictures that do not say enough, or too much, are refused") {
  const TemporaryFolder folder;
  write_whole(folder / "p.pgm", "P2 2 1 4\n1 4\n");
  write_whole(folder / "black.pgm", "P2 2 1 4\n0 0\n");
  write_whole(folder / "p.pfm", pfm_bytes({{1, 3e20f}}, "-1.0"));
  write_whole(folder / "bad.pfm", pfm_bytes({{1, 1}, {1, -1}}, "-1.0"));
  write_whole(folder / "colour.png", PngBytes(1, 1, 8, 2).with_rows({"abc"}));
  const auto refused = [&](const std::string& target, const std::string& part) {
    INFO(target);
    CHECK_THROWS_WITH(scene(target), Catch::Contains(part));
  };
  refused("width = 60\npeak = 1\n", "target.file: is missing");
  refused(in(folder, "p.pgm") + "peak = 1\n", "target.width");
  refused(in(folder, "p.pgm") + "width = 60\n", "target.peak");
  refused(in(folder, "p.pgm") + "width = 60\npeak = 1\ntransfer = \"gamma\"\n", "target.gamma");
  refused(in(folder, "p.pgm") + "width = 60\npeak = 1\ntransfer = \"srgb\"\ngamma = 2\n", "has no effect");
  refused(in(folder, "p.pgm") + "width = 60\npeak = 1\nradius = 2\n", "does not belong");
  refused(in(folder, "black.pgm") + "width = 60\npeak = 1\n", "black everywhere");
  refused(in(folder, "p.pfm") + "width = 60\n", "row 1, column 2");
  refused(in(folder, "p.pfm") + "width = 60\ngamma = 2\n", "has no effect");
  refused(in(folder, "bad.pfm") + "width = 60\n", "row 2, column 2: the value is negative");
  refused(in(folder, "colour.png") + "width = 60\npeak = 1\n", "has colours");
  refused(in(folder, "none.png") + "width = 60\npeak = 1\n", "none.png");
}

TEST_CASE("what no symmetric light can be: closed forms of pictures that are not symmetric") {
  const double radius = 100;
  const sim::NearField disc = sim::NearField::disc({0, 0, -50}, {0, 0, 1}, radius);
  // 1 + a x: means over rings are 1, the rest has a mean square of a^2 R^2 / 4
  const double a = 0.006, rest = a * a * radius * radius / 4;
  const Picture ramp = drawn(210, [&](double x, double) { return 1 + a * x; });
  CHECK(asymmetry_rel(ramp, disc) == Approx(std::sqrt(rest / (1 + rest))).epsilon(1e-3));
  const Picture upright = drawn(210, [&](double, double y) { return 1 + a * y; });
  CHECK(asymmetry_rel(upright, disc) == Approx(std::sqrt(rest / (1 + rest))).epsilon(1e-3));
  // half dark: 1 and 0, of which rings have a mean of 1/2
  const Picture half = drawn(210, [](double x, double) { return x > 0 ? 1.0 : 0.0; });
  CHECK(asymmetry_rel(half, disc) == Approx(std::sqrt(0.5)).epsilon(2e-3));
  const Picture bowl = drawn(210, [](double x, double y) { return x * x + y * y; });
  CHECK(asymmetry_rel(bowl, disc) < 1e-3);
}

TEST_CASE("a picture that is small on its near field is seen as finely as a large one") {
  // the ramp on a disc once more, on a field a thousand times as wide, which is dark beyond
  const double radius = 100, a = 0.006;
  const Picture picture =
      drawn(210, [&](double x, double y) { return std::hypot(x, y) < radius ? 1 + a * x : 0.0; });
  const double rest = a * a * radius * radius / 4;
  for (const double wide : {150.0, 1e5}) {
    const sim::NearField field = sim::NearField::disc({0, 0, -50}, {0, 0, 1}, wide);
    CHECK(asymmetry_rel(picture, field) == Approx(std::sqrt(rest / (1 + rest))).epsilon(0.01));
  }
}

TEST_CASE("symmetric is about the axis, not about the near field's centre") {
  const sim::NearField aside = sim::NearField::disc({30, -20, -50}, {0, 0, 1}, 40);
  const Picture about_axis =
      drawn(90, [](double x, double y) { return std::pow(x + 30, 2) + std::pow(y - 20, 2); });
  CHECK(asymmetry_rel(about_axis, aside) < 1e-3);
  const Picture about_centre = drawn(90, [](double x, double y) { return x * x + y * y; });
  CHECK(asymmetry_rel(about_centre, aside) > 0.3);
}

TEST_CASE("the note on symmetry stands where the near field is across the axis, and only there") {
  const TemporaryFolder folder;
  write_whole(folder / "p.pgm", "P2 2 1 4\n1 4\n");
  const auto notes = [&](const std::string& normal) {
    const std::string text =
        "[source]\npower = 1\n[reflector]\npoints = [[0, 10], [5, 10], [10, 5]]\n"
        "[near_field]\ncenter = [0, 0, -100]\nradius = 40\nnormal = " +
        normal + "\n[target]\nkind = \"image\"\nwidth = 90\npeak = 1\n" + in(folder, "p.pgm");
    std::string all;
    for (const std::string& note : make_scene(Settings::parse(text, "s.toml", scene_keys())).target.notes)
      all += note + "\n";
    return all;
  };
  CHECK_THAT(notes("[0, 0, 1]"), Catch::Contains("not symmetric about the axis"));
  CHECK_THAT(notes("[0, 0, -1]"), Catch::Contains("not symmetric about the axis"));
  CHECK_THAT(notes("[0, 1, 1]"), !Catch::Contains("symmetric"));
}
