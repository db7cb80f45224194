#include "design/field_figures.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "design/judge.h"
#include "design/run.h"
#include "design/target.h"

// A point source above a plane: E = I h / (h^2 + r^2)^(3/2), and what follows from it in closed form.

using namespace catoptric;
using namespace catoptric::design;

namespace {

constexpr double power_w = 100, height_mm = 1000;

/// A black bowl above the source: only its own light arrives.
Scene scene(const std::string& field, const std::string& target = "") {
  const std::string text =
      "[source]\nposition = [0, 0, 0]\npower = 100\n[reflector]\nreflectance = 0\npoints = [[0, 30], [30, "
      "30], "
      "[40, 10]]\n[near_field]\ncenter = [0, 0, -1000]\nnormal = [0, 0, 1]\n" +
      field + "[model]\nphotons = 1000\nkernel_radius = 100\n" + target;
  return make_scene(Settings::parse(text, "s.toml", scene_keys()));
}

FieldFigures figures(const Scene& spec, sim::Rung rung = sim::Rung::tubes) {
  return judge(spec, make_target(spec), start_candidate(spec), rung, 1).field;
}

double irradiance(double radius_mm) {
  return power_w / (4 * pi) * height_mm / std::pow(height_mm * height_mm + radius_mm * radius_mm, 1.5);
}

/// Flux of the source within a radius: half of it, less what goes out more flatly.
double flux_within(double radius_mm) {
  return power_w / 2 * (1 - height_mm / std::hypot(height_mm, radius_mm));
}

}  // namespace

TEST_CASE("a point above a disc: average, least, greatest, evenness and flux by rings are the closed forms") {
  constexpr double radius = 800;
  constexpr int samples = 4096;
  const FieldFigures field = figures(scene("radius = 800\nsamples = 4096\n"));
  const double area = pi * radius * radius;
  // the spiral's samples stand at the middles of rings of equal area: a midpoint rule of 4096 steps
  CHECK(field.flux_w->value == Approx(flux_within(radius)).epsilon(1e-6));
  CHECK(field.average_w_per_mm2.value == Approx(flux_within(radius) / area).epsilon(1e-6));
  const double outermost = radius * std::sqrt((samples - 0.5) / samples),
               innermost = radius * std::sqrt(0.5 / samples);
  CHECK(field.least_w_per_mm2.value == Approx(irradiance(outermost)).epsilon(1e-9));
  CHECK(field.greatest_w_per_mm2.value == Approx(irradiance(innermost)).epsilon(1e-9));
  CHECK(field.uniformity.value == Approx(irradiance(outermost) * area / flux_within(radius)).epsilon(1e-6));
  CHECK(field.diversity.value == Approx(irradiance(outermost) / irradiance(innermost)).epsilon(1e-9));
  REQUIRE(field.zones.size() == 4);
  for (std::size_t i = 0; i < 4; ++i) {
    INFO(i);
    const ZoneFigures& zone = field.zones[i];
    const double from = 200.0 * static_cast<double>(i), to = from + 200;
    CHECK(zone.from_mm == Approx(from));
    REQUIRE(zone.to_mm);
    CHECK(*zone.to_mm == Approx(to));
    CHECK(zone.samples == (2 * i + 1) * samples / 16);  // rings of equal width have areas of 1, 3, 5, 7
    CHECK(zone.flux_w.value == Approx(flux_within(to) - flux_within(from)).epsilon(1e-5));
    CHECK(zone.irradiance_w_per_mm2.value ==
          Approx((flux_within(to) - flux_within(from)) / (pi * (to * to - from * from))).epsilon(1e-5));
    CHECK(zone.flux_w.noise == 0);
    CHECK(zone.flux_w.bias == Approx(0).margin(1e-12));
    CHECK(zone.flux_w.half_interval == 0.0);
  }
}

TEST_CASE("a target's zones have their own flux, and what lies beyond them too") {
  const FieldFigures field =
      figures(scene("radius = 800\nsamples = 6400\n",
                    "[target]\nkind = \"zones\"\nradii = [300, 500]\nirradiances = [5, 2]\n"));
  CHECK(field.zones_about_axis);
  REQUIRE(field.zones.size() == 3);
  const double edges[] = {0, 300, 500, 800};
  double all = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    // samples next to an edge count in full for one side: one of some 900 at most
    CHECK(field.zones[i].flux_w.value ==
          Approx(flux_within(edges[i + 1]) - flux_within(edges[i])).epsilon(2e-3));
    all += field.zones[i].flux_w.value;
  }
  CHECK_FALSE(field.zones[2].to_mm);
  CHECK(all == Approx(field.flux_w->value).epsilon(1e-12));
}

TEST_CASE("on a rectangle the whole is the one zone, and its flux is that of its solid angle") {
  const FieldFigures field =
      figures(scene("shape = \"rectangle\"\nwidth = 1200\nheight = 800\nsamples = 9600\n"));
  CHECK(field.zones.empty());
  // solid angle of a rectangle about the foot of its distance: 4 asin(ab / sqrt((a^2 + h^2)(b^2 + h^2)))
  const double a = 600, b = 400, h2 = height_mm * height_mm;
  const double angle = 4 * std::asin(a * b / std::sqrt((a * a + h2) * (b * b + h2)));
  CHECK(field.flux_w->value == Approx(power_w * angle / (4 * pi)).epsilon(1e-4));
  CHECK(field.uniformity.value < 1);
}

TEST_CASE("a table of points stands for no area: no flux, no zones") {
  const Scene spec = scene("radius = 800\nsamples = 64\n");
  Scene of_table = spec;
  of_table.target.kind = TargetKind::csv;
  const std::vector<sim::FieldSample> samples = spec.near_field.samples(4);
  const Rows dark(1, std::vector<double>(4, 0.0));
  const FieldFigures field = field_figures(of_table, samples, {4, 2, 3, 3}, dark, dark);
  CHECK_FALSE(field.flux_w);
  CHECK(field.zones.empty());
  CHECK(field.average_w_per_mm2.value == 3);
  CHECK(field.uniformity.value == Approx(2 / 3.0));
  CHECK(field.diversity.value == 0.5);
  const FieldFigures nothing = field_figures(spec, samples, {0, 0, 0, 0}, dark, dark);
  CHECK(nothing.uniformity.value == 0);
  CHECK(nothing.diversity.value == 0);
}

TEST_CASE("photons and tubes agree on what a mirror's near field gets") {
  const Scene spec = read_scene(std::string(CATOPTRIC_DATA) + "/paper/paraboloid.toml",
                                {{"model.photons", "65536", "test"}});
  const FieldFigures exact = figures(spec), noisy = figures(spec, sim::Rung::photons);
  const auto agree = [](const Figure& truth, const Figure& found) {
    REQUIRE(found.half_interval);
    CHECK(found.noise > 0);
    // twice the half width of a 95 % interval, and what is left of the blur
    CHECK(std::abs((found.value - found.bias) - (truth.value - truth.bias)) <
          2 * *found.half_interval + 0.1 * std::abs(found.bias));
  };
  agree(exact.average_w_per_mm2, noisy.average_w_per_mm2);
  agree(*exact.flux_w, *noisy.flux_w);
  REQUIRE(exact.zones.size() == noisy.zones.size());
  for (std::size_t i = 0; i < exact.zones.size(); ++i) {
    agree(exact.zones[i].flux_w, noisy.zones[i].flux_w);
    agree(exact.zones[i].irradiance_w_per_mm2, noisy.zones[i].irradiance_w_per_mm2);
  }
}
