#include "sim/surroundings.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <numeric>

#include "base/errors.h"
#include "base/units.h"
#include "sim/disc_source.h"
#include "sim/fresnel.h"
#include "sim/object_shapes.h"
#include "sim/photon_fields.h"
#include "sim/ray_source.h"
#include "sim/rings.h"
#include "sim/simulation.h"
#include "support/flat_mirror.h"
#include "support/quadrature.h"
#include "support/statistics.h"

/// Things about the mirror, by what is known of their light in closed form.

using namespace catoptric;
using namespace catoptric::sim;

namespace {

/// One ray, time and again.
class Beam final : public RayBundle {
 public:
  explicit Beam(const Vector3& direction) : ray_{Vector3::Zero(), direction.normalized()} {}
  std::uint64_t count() const override { return 1; }
  double extent_mm() const override { return 0; }
  Ray pick(double) const override { return ray_; }

 private:
  Ray ray_;
};

/// A mirror that no photon of these tests meets.
const test::FlatMirror out_of_the_way{1e6, 1};

Object pane(double front_z_mm, double thickness_mm, const Glass& glass, double radius_mm = 1e4) {
  Object object{"pane", {}, {0, 0}, glass};
  object.faces = {make_disc({0, 0, front_z_mm}, {0, 0, -1}, radius_mm),
                  make_disc({0, 0, front_z_mm + thickness_mm}, {0, 0, 1}, radius_mm)};
  return object;
}

struct Shares {
  double through, back, kept;
};

/// Of all reflections within a plate, for one polarisation.
Shares plate(double reflectance, double internal) {
  const double through = std::pow(1 - reflectance, 2) * internal / (1 - std::pow(reflectance * internal, 2));
  const double back = reflectance * (1 + internal * through);
  return {through, back, 1 - through - back};
}

Shares mean(const Shares& a, const Shares& b) {
  return {0.5 * (a.through + b.through), 0.5 * (a.back + b.back), 0.5 * (a.kept + b.kept)};
}

double share_p(double share, double wanted, std::uint64_t photons) {
  const auto n = static_cast<double>(photons);
  return test::normal_p((share - wanted) / std::sqrt(wanted * (1 - wanted) / n));
}

}  // namespace

TEST_CASE("a plate lets through, throws back and absorbs what Fresnel and Beer say, at every angle") {
  const Glass glass{1.5, 0.05};
  constexpr double thickness_mm = 3;
  constexpr std::uint64_t photons = 200'000;
  const NearField beyond = NearField::disc({0, 0, 50}, {0, 0, -1}, 1e6, Material{0, 0});
  const Surroundings room({pane(20, thickness_mm, glass)}, {});
  for (const double angle_deg : {0.0, 30.0, 56.3, 75.0, 85.0}) {
    const double angle = angle_deg * pi / 180, inside = std::asin(std::sin(angle) / glass.index);
    const RaySource beam({0, 0, 0}, 1, std::make_shared<Beam>(Vector3(std::sin(angle), 0, std::cos(angle))),
                         {0, 0, 1}, {1, 0, 0});
    const Scene scene{beam, out_of_the_way, {0, 0}, beyond, &room};
    const TracedPhotons light = trace_photons(scene, {photons, Sampler::random, 7}, 0);
    const PolarisedReflectance surface = polarised_reflectance(std::cos(angle), glass.index);
    const double internal = std::exp(-glass.absorption_per_mm * thickness_mm / std::cos(inside));
    const Shares wanted = mean(plate(surface.across, internal), plate(surface.along, internal));
    INFO(angle_deg << " degrees");
    CHECK(test::plausible(share_p(light.energy.received_w, wanted.through, photons)));
    CHECK(test::plausible(share_p(light.energy.stopped_w, wanted.kept, photons)));
    CHECK(test::plausible(share_p(light.energy.escaped_w, wanted.back, photons)));
    CHECK(light.energy.missed_w == 0);
    const Shares unpolarised = plate(surface.mean(), internal);  // light that forgets its polarisation inside
    if (angle_deg > 56 && angle_deg < 80)
      CHECK(test::rejected(share_p(light.energy.received_w, unpolarised.through, photons)));
  }
}

TEST_CASE("a plate shifts a beam and does not turn it") {
  const Glass glass{1.6, 0};
  const double angle = 0.7, inside = std::asin(std::sin(angle) / glass.index), thickness_mm = 4;
  const NearField beyond = NearField::disc({0, 0, 50}, {0, 0, -1}, 1e5, Material{0, 0});
  const Surroundings room({pane(20, thickness_mm, glass)}, {});
  const RaySource beam({0, 0, 0}, 1, std::make_shared<Beam>(Vector3(std::sin(angle), 0, std::cos(angle))),
                       {0, 0, 1}, {1, 0, 0});
  const Scene scene{beam, out_of_the_way, {0, 0}, beyond, &room};
  const double straight_mm = (50 - thickness_mm) * std::tan(angle) + thickness_mm * std::tan(inside);
  const double step_mm = 2 * thickness_mm * std::tan(inside);  // what each way there and back adds
  std::vector<int> orders(40);
  PhotonFlights(scene, RecordedArea::about(beyond, 0))
      .fly({20'000, Sampler::random, 3}, [&](std::uint64_t, std::vector<Crossing>&& crossings) {
        for (const Crossing& crossing : crossings) {
          const Vector3 at = beyond.to_space(crossing.plane_mm());
          CHECK(std::abs(at.y()) < 1e-12);
          const double order = (at.x() - straight_mm) / step_mm;
          CHECK(std::abs(order - std::round(order)) < 1e-12);
          ++orders.at(static_cast<std::size_t>(std::round(order)));
        }
      });
  CHECK(orders[0] > 15'000);
  CHECK(orders[1] > 20);
}

TEST_CASE("a dome about a point dims its light and leaves it where it was") {
  const Glass glass{1.5, 0.02};
  Object dome{"dome", {}, {0, 0}, glass};
  dome.faces = {make_cap({0, 0, 0}, {0, 0, 1}, 20, pi),
                make_cap({0, 0, 0}, {0, 0, 1}, 15, pi, SphereFront::inside)};
  const NearField field = NearField::disc({0, 0, 60}, {0, 0, -1}, 40);
  const PointSource point({0, 0, 0}, 3);
  const Surroundings room({dome}, {});
  const Scene scene{point, out_of_the_way, {0, 0}, field, &room};
  const std::vector<FieldSample> samples = field.samples(12);
  const FieldEstimate light =
      simulate(scene, samples, {400'000, Sampler::random, 5}, {Kernel::silverman, std::nullopt, 4});
  const double surface = std::pow((glass.index - 1) / (glass.index + 1), 2);
  const double through = plate(surface, std::exp(-5 * glass.absorption_per_mm)).through;
  std::vector<double> wanted, clear;
  for (const FieldSample& sample : samples) {
    clear.push_back(point.unhindered_w_per_mm2(sample.point_mm, sample.normal));
    wanted.push_back(through * clear.back());
  }
  CHECK(std::ranges::all_of(light.direct, [](double direct) { return direct == 0; }));
  CHECK(test::plausible(test::z_test_p(light.reflected, wanted, light.noise)));
  CHECK(test::rejected(test::z_test_p(light.reflected, clear, light.noise)));
}

TEST_CASE("a black baffle takes the light of its solid angle, and shades direct light to the edge",
          "[threads]") {
  const PointSource point({0, 0, 0}, 1);
  const NearField field = NearField::disc({0, 0, -100}, {0, 0, 1}, 80);
  const test::FlatMirror mirror{20, 60};
  const Object ring{"baffle", {make_disc({0, 0, -10}, {0, 0, 1}, 5)}, {0, 0}, {}};
  const Surroundings room({ring}, {});
  const Scene scene{point, mirror, {1, 0}, field, &room};
  for (const FieldSample& sample : field.samples(200)) {
    const double r = sample.point_mm.head<2>().norm();
    const double direct = direct_field(scene, std::array{sample}).front();
    CHECK(direct == (r < 50 ? 0 : point.unhindered_w_per_mm2(sample.point_mm, sample.normal)));
  }
  // From the mirror's image of the point 40 mm above, the baffle's shadow on the field is 140 / 50 as wide.
  const auto light =
      simulate(scene, field.samples(60), {300'000, Sampler::random, 2}, {Kernel::silverman, std::nullopt, 3});
  const PointSource image({0, 0, 40}, 1);
  std::vector<double> values, wanted, noise;
  const auto samples = field.samples(60);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double r = samples[i].point_mm.head<2>().norm();
    if (r < 14 - 3.1) CHECK(light.reflected[i] == 0);
    if (r < 14 + 3.1) continue;
    values.push_back(light.reflected[i]);
    noise.push_back(light.noise[i]);
    wanted.push_back(image.unhindered_w_per_mm2(samples[i].point_mm, samples[i].normal));
  }
  CHECK(test::plausible(test::z_test_p(values, wanted, noise)));
  const double emitted = light.energy.emitted_w;
  CHECK(light.energy.stopped_w > 0);
  CHECK(light.energy.missed_w + light.energy.absorbed_w + light.energy.stopped_w + light.energy.received_w +
            light.energy.escaped_w + light.energy.cut_off_w ==
        Approx(emitted).epsilon(1e-12));
}

TEST_CASE("further fields see the photons that they see as near fields") {
  const LambertianDisc source({3, 0, 10}, 2, {0.3, 0, 1}, 2);
  const test::FlatMirror mirror{20, 60};
  const NearField floor = NearField::disc({0, 0, -20}, {0, 0, 1}, 30);
  const NearField side = NearField::rectangle({25, 0, 0}, {-1, 0, 0}, {0, 1, 0}, 20, 30);
  const PhotonOptions photons{50'000, Sampler::sobol, 9};
  const EstimateOptions estimate{Kernel::silverman, std::nullopt, 2};
  const Surroundings room({}, {{"side", side, 1.5}});
  std::vector<FieldSample> both = floor.samples(50);
  for (FieldSample sample : side.samples(50)) {
    sample.field = 1;
    both.push_back(sample);
  }
  const FieldEstimate together = simulate({source, mirror, {0.8, 0}, floor, &room}, both, photons, estimate);
  const FieldEstimate first =
      simulate({source, mirror, {0.8, 0}, floor}, floor.samples(50), photons, estimate);
  const FieldEstimate second = simulate({source, mirror, {0.8, 0}, side}, side.samples(50), photons,
                                        {Kernel::silverman, std::nullopt, 3});
  for (std::size_t i = 0; i < 50; ++i) {
    CHECK(together.reflected[i] == first.reflected[i]);
    CHECK(together.reflected[50 + i] == second.reflected[i]);
    CHECK(together.direct[50 + i] == second.direct[i]);
  }
  CHECK(std::accumulate(second.reflected.begin(), second.reflected.end(), 0.0) > 0);
}

TEST_CASE("a cylinder has no seam, and its light is that of the image behind the mirror", "[threads]") {
  const PointSource point({2, 1, 0}, 4), image({2, 1, 40}, 4);
  const test::FlatMirror mirror{20, 200};
  const NearField tube = NearField::cylinder({0, 0, -40}, {0, 0, 1}, 30, 40, true);
  const NearField nowhere = NearField::disc({0, 0, 900}, {0, 0, 1}, 1);
  const Surroundings room({}, {{"wall", tube, 1}});
  std::vector<FieldSample> samples;
  for (const double x_mm : {0.0, 40.0, 94.2, -94.2, -60.0})
    samples.push_back({tube.to_space({x_mm, 3}), tube.front_at({x_mm, 3}), 1});
  const FieldEstimate light = simulate({point, mirror, {1, 0}, nowhere, &room}, samples,
                                       {1'000'000, Sampler::random, 4}, {Kernel::silverman, std::nullopt, 3});
  std::vector<double> wanted;
  for (const FieldSample& sample : samples)
    wanted.push_back(image.unhindered_w_per_mm2(sample.point_mm, sample.normal));
  CHECK(test::plausible(test::z_test_p(light.reflected, wanted, light.noise)));
  CHECK(light.reflected[2] == Approx(light.reflected[3]).epsilon(0.2));  // 0.1 mm beside the seam
}

TEST_CASE("in a closed room all light ends, after as many meetings as its walls' reflectance allows",
          "[long]") {
  constexpr double reflectance = 0.7;
  constexpr std::uint64_t photons = 100'000;
  const Material grey = Material::matt(reflectance);
  const NearField floor = NearField::disc({0, 0, -50}, {0, 0, 1}, 40, grey);
  const Surroundings room({}, {{"ceiling", NearField::disc({0, 0, 50}, {0, 0, -1}, 40, grey)},
                               {"wall", NearField::cylinder({0, 0, 0}, {0, 0, 1}, 40, 100, true, grey)}});
  const PointSource point({5, 0, 10}, 1);
  const TracedPhotons light =
      trace_photons({point, out_of_the_way, {0, 0}, floor, &room}, {photons, Sampler::random, 8}, 0);
  // The number of meetings is geometric: mean 1 / (1 - rho), variance rho / (1 - rho)^2.
  const double wanted = 1 / (1 - reflectance), sigma = std::sqrt(reflectance) / (1 - reflectance);
  const double n = static_cast<double>(photons), found = static_cast<double>(light.counts.interactions) / n;
  CHECK(test::plausible(test::normal_p((found - wanted) / (sigma / std::sqrt(n)))));
  CHECK(light.energy.escaped_w == 0);
  // Those absorbed at their first wall were on their way straight from the source.
  CHECK(light.energy.received_w + light.energy.missed_w == Approx(1).epsilon(1e-12));
  CHECK(test::plausible(share_p(light.energy.received_w, reflectance, photons)));
}

TEST_CASE("an integrating sphere has the same light everywhere, of all its reflections", "[long]") {
  constexpr double reflectance = 0.9, radius_mm = 100, power_w = 2;
  const Object sphere{
      "sphere", {make_cap({0, 0, 0}, {0, 0, 1}, radius_mm, pi)}, Material::matt(reflectance), {}};
  const PointSource point({0, 0, 0}, power_w);
  const NearField inside = NearField::disc({30, 10, -50}, {0.2, 0.3, 1}, 20);
  const Surroundings room({sphere}, {});
  const Scene scene{point, out_of_the_way, {0, 0}, inside, &room};
  const std::vector<FieldSample> samples = inside.samples(9);
  // The wall is lit evenly from its centre, and evenly again by its own light: a Lambertian wall of a sphere
  // gives all of its places the same. Within it the radiance is that of the wall from everywhere.
  const double wall = power_w / (4 * pi * radius_mm * radius_mm);
  const double of_reflections = wall * reflectance / (1 - reflectance);
  // Photons cross the disc several times each, so their crossings are no independent events: sets tell the
  // noise.
  constexpr std::size_t sets = 24;
  std::vector<std::vector<double>> of_sample(samples.size());
  for (std::uint64_t set = 0; set < sets; ++set) {
    const FieldEstimate light =
        simulate(scene, samples, {20'000, Sampler::random, 11, set}, {Kernel::silverman, std::nullopt, 8});
    for (std::size_t i = 0; i < samples.size(); ++i) of_sample[i].push_back(light.reflected[i]);
    CHECK(light.energy.escaped_w == 0);
    CHECK(light.energy.stopped_w + light.energy.received_w == Approx(power_w).epsilon(1e-12));
    CHECK(light.direct[0] ==
          Approx(point.unhindered_w_per_mm2(samples[0].point_mm, samples[0].normal)).epsilon(1e-15));
  }
  const double darker = wall * 0.85 / (1 - 0.85);
  for (const std::vector<double>& values : of_sample) {
    CHECK(test::plausible(test::student_p(values, of_reflections)));
    CHECK(test::rejected(test::student_p(values, darker)));
  }
}

TEST_CASE("a real near field stands in the way of further fields") {
  const PointSource point({0, 0, 100}, 1);
  const NearField table = NearField::disc({0, 0, 50}, {0, 0, 1}, 20, Material{0, 0});
  const NearField floor = NearField::disc({0, 0, 0}, {0, 0, 1}, 90);
  const Surroundings room({}, {{"floor", floor, 1}});
  for (FieldSample sample : floor.samples(100)) {
    sample.field = 1;
    const double direct =
        direct_field({point, out_of_the_way, {0, 0}, table, &room}, std::array{sample}).front();
    const bool in_shadow = sample.point_mm.head<2>().norm() < 40;
    CHECK(direct == (in_shadow ? 0 : point.unhindered_w_per_mm2(sample.point_mm, sample.normal)));
  }
}

TEST_CASE("light that a near field sends to a further field does not know the mirror it never met",
          "[long]") {
  const PointSource point({0, 0, 30}, 1);
  const NearField floor = NearField::disc({0, 0, 0}, {0, 0, 1}, 40, Material::matt(0.8));
  const NearField ceiling = NearField::disc({0, 0, 60}, {0, 0, -1}, 40);
  const Surroundings room({}, {{"ceiling", ceiling, 1}});
  std::vector<FieldSample> samples = ceiling.samples(9);
  for (FieldSample& sample : samples) sample.field = 1;
  const auto light = [&](const Material& mirror) {
    return simulate({point, out_of_the_way, mirror, floor, &room}, samples, {200'000, Sampler::random, 6},
                    {Kernel::silverman, std::nullopt, 6});
  };
  const FieldEstimate bright = light({1, 0}), dim = light({0.25, 0});
  CHECK(bright.reflected == dim.reflected);
  // A ring of the floor lights the ceiling above its centre by Lambert's law.
  const double power_w = test::integral(0, 40, 8, [&](double r) {
    const double there = point.unhindered_w_per_mm2({r, 0, 0}, {0, 0, 1}), square = r * r + 60.0 * 60;
    return 0.8 * there / pi * 2 * pi * r * 60 * 60 / (square * square);
  });
  const std::vector<FieldSample> middle{{{0, 0, 60}, {0, 0, -1}, 1}};
  const FieldEstimate above = simulate({point, out_of_the_way, {1, 0}, floor, &room}, middle,
                                       {2'000'000, Sampler::random, 6}, {Kernel::silverman, std::nullopt, 5});
  CHECK(test::plausible(test::z_test_p(above.reflected, {power_w}, above.noise)));
  CHECK(test::rejected(test::z_test_p(above.reflected, {0.6 * power_w}, above.noise)));
}

TEST_CASE("round things about the axis are the same to rings as to photons", "[long]") {
  const LambertianDisc source({0, 0, 10}, 2, {0, 0, 1}, 2);
  const test::FlatMirror mirror{20, 60};
  const NearField floor = NearField::disc({0, 0, -20}, {0, 0, 1}, 30);
  const Object baffle{"baffle", {make_disc({0, 0, -10}, {0, 0, 1}, 40, 12)}, {0, 0}, {}},
      tube{"tube", {make_tube({0, 0, 0}, {0, 0, 1}, 25, 20)}, Material::matt(0.5), {}};
  const Glass glass{1.5, 0.2};
  const Surroundings room({pane(-5, 2, glass), baffle, tube}, {}), open({baffle, tube}, {});
  std::vector<FieldSample> samples;
  std::vector<double> radii;
  for (const double radius : {2.0, 8.0, 14.0, 20.0, 26.0}) {
    samples.push_back({{radius * std::cos(radius), radius * std::sin(radius), -20}, {0, 0, 1}});
    radii.push_back(radius);
  }
  const FieldEstimate photons =
      simulate({source, mirror, {0.8, 0}, floor, &room}, samples, {300'000, Sampler::random, 4},
               {Kernel::silverman, std::nullopt, 2.5});
  const auto rings = [&](const Surroundings& about) {
    RingsOptions options;
    options.photons = {1'000'000, Sampler::sobol, 5};
    options.widest_kernel_radius_mm = 2.5;
    return RingPhotons({source, mirror, {0.8, 0}, floor, &about}, options).smoothed(radii, 2.5);
  };
  CHECK(test::plausible(test::z_test_p(photons.reflected, rings(room), photons.noise)));
  CHECK(test::rejected(test::z_test_p(photons.reflected, rings(open), photons.noise)));
}

TEST_CASE("rings say what is not round about the axis") {
  const PointSource point({0, 0, 10}, 1);
  const test::FlatMirror mirror{20, 60};
  const NearField floor = NearField::disc({0, 0, -20}, {0, 0, 1}, 30);
  const auto objection = [&](const ShapePointer& shape) {
    const Surroundings room({{"thing", {shape}, {0, 0}, {}}}, {});
    return rings_objection({point, mirror, {1, 0}, floor, &room}).value_or("");
  };
  CHECK(objection(make_disc({0, 0, 1}, {0, 0, -3}, 5, 2)) == "");
  CHECK(objection(make_cap({0, 0, 1}, {1, 0, 0}, 5, pi)) == "");
  CHECK(objection(make_tube({0, 0, 1}, {0, 0, 2}, 5, 2)) == "");
  for (const ShapePointer& shape :
       {make_disc({1e-3, 0, 1}, {0, 0, 1}, 5), make_disc({0, 0, 1}, {1e-4, 0, 1}, 5),
        make_cap({0, 0, 1}, {1, 0, 1}, 5, 1), make_cap({0, 1, 1}, {0, 0, 1}, 5, pi),
        make_tube({0, 0, 1}, {0, 1, 1}, 5, 2), make_rectangle({0, 0, 1}, {0, 0, 1}, {1, 0, 0}, 5, 5)})
    CHECK(objection(shape) == "thing is not round about the axis");
  const Surroundings more({}, {{"wall", floor, 1}});
  CHECK_THAT(*rings_objection({point, mirror, {1, 0}, floor, &more}),
             Catch::Contains("wall is a further field"));
}
