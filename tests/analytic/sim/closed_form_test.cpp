#include <catch2/catch.hpp>
#include <cmath>

#include "base/units.h"
#include "cad/engines.h"
#include "sim/bandwidth_ladder.h"
#include "sim/closed_forms.h"
#include "sim/ladder_error.h"
#include "sim/tubes.h"

using namespace catoptric;
using namespace catoptric::sim;

namespace {

Profile paraboloid_profile() { return Profile::bezier({{0, 100, 1}, {50, 100, 1}, {100, 50, 1}}); }

/// Less than a half of the sphere of radius 50 mm about (0, 50).
Profile sphere_profile() { return Profile::bezier({{0, 100, 1}, {50, 100, std::sqrt(0.5)}, {50, 50, 1}}); }

std::optional<ClosedForm> form_of(const Profile& profile, const Vector3& source_mm, const NearField& field,
                                  const Material& material = {}) {
  const auto mirror = cad::make_meridian_reflector(profile);
  const PointSource source(source_mm, 10);
  return closed_form({source, *mirror, material, field}, field.samples(100));
}

/// Error of the closed form against photons that know nothing of it, in the photons' own 95 % bounds.
double off_in_bounds(const Profile& profile, const NearField& field, const Material& material) {
  const auto mirror = cad::make_meridian_reflector(profile);
  const PointSource source({0, 0, 50}, 10);
  const Scene scene{source, *mirror, material, field};
  const auto samples = field.samples(200);
  const auto form = closed_form(scene, samples);
  REQUIRE(form);
  PhotonSets sets(scene, Rung::photons);
  const double widest_mm = 0.5 * widest_kernel_radius_mm(field);
  sets.fly({300'000, Sampler::sobol, 1, 0, 1000}, 4, widest_mm);
  const BandwidthLadder ladder = sets.look(samples, widest_mm, 8);
  const LadderChoice choice = best_choice(summary_of(ladder, false));
  const auto photons = mean_of(fields_of(ladder[choice.level], choice.order));
  double square = 0;
  for (std::size_t i = 0; i < photons.size(); ++i)
    square += std::pow(photons[i] - form->reflected[i], 2) / static_cast<double>(photons.size());
  CHECK(choice.error95 < 0.02 * form->reflected[0]);  // else anything would agree
  return std::sqrt(square) / choice.error95;
}

}  // namespace

TEST_CASE("paraboloid and sphere are recognised, and photons agree") {
  const NearField tilted =
      NearField::rectangle({10, 0, -40}, {0, 0.5, 0.8660254037844386}, {1, 0, 0}, 60, 50);
  const NearField level = NearField::disc({0, 0, 0}, {0, 0, 1}, 40);
  CHECK(off_in_bounds(paraboloid_profile(), level, {}) < 1);
  CHECK(off_in_bounds(paraboloid_profile(), tilted, {0.85, 0}) < 1);
  CHECK(off_in_bounds(sphere_profile(), level, {0.7, 0}) < 1);
}

TEST_CASE("closed forms carry the reflectance at their incidence, as tubes do") {
  const NearField field = NearField::disc({0, 0, 0}, {0, 0, 1}, 90);
  const PointSource focus({0, 0, 50}, 10);
  for (const Profile& profile : {paraboloid_profile(), sphere_profile()}) {
    const auto mirror = cad::make_meridian_reflector(profile);
    for (const Material& material : {Material::metal(0.4, 2), Material::with_table({0, 0.8}, {1, 0.5})}) {
      const Scene scene{focus, *mirror, material, field};
      const auto samples = field.samples(50);
      const auto form = closed_form(scene, samples);
      REQUIRE(form);
      // Head-on a cosine tells angles to 2e-8 rad only, by which a table may slope.
      const bool head_on = form->name != "paraboloid with the source in its focus";
      const TubesField tubes = tubes_field(scene, samples, {});
      for (std::size_t i = 0; i < samples.size(); ++i)
        CHECK(tubes.irradiance[i] == Approx(form->reflected[i]).epsilon(head_on ? 3e-8 : 1e-10));
    }
    CHECK_FALSE(closed_form({focus, *mirror, {0.8, 0, 0, 0.1}, field}, field.samples(5)));
    CHECK_FALSE(closed_form({focus, *mirror, {0.8, 0, 0.1}, field}, field.samples(5)));
  }
}

TEST_CASE("the paraboloid's form is eq. 12, whatever the degree and direction") {
  const NearField field = NearField::disc({0, 0, 0}, {0, 0, 1}, 120);
  const auto form = form_of(paraboloid_profile(), {0, 0, 50}, field);
  REQUIRE(form);
  const auto samples = field.samples(100);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double r = samples[i].point_mm.head<2>().norm(), t = 1 + r * r / 10'000;
    const double wanted = r <= 100 ? 10 / (4 * pi * 2500 * t * t) : 0.0;
    CHECK(form->reflected[i] == Approx(wanted).epsilon(1e-12));
  }
  // upside down, lighting a field above from below
  const Profile turned = Profile::bezier({{0, -100, 1}, {50, -100, 1}, {100, -50, 1}});
  const NearField above = NearField::disc({0, 0, 0}, {0, 0, -1}, 90);
  CHECK(form_of(turned, {0, 0, -50}, above)->reflected[0] ==
        Approx(form_of(paraboloid_profile(), {0, 0, 50}, field)->reflected[0]).epsilon(0.05));
  // light that arrives from behind does not count
  CHECK(form_of(paraboloid_profile(), {0, 0, 50}, NearField::disc({0, 0, 0}, {0, 0, -1}, 90))->reflected[5] ==
        0);
}

TEST_CASE("no formula is claimed where there is none") {
  const NearField field = NearField::disc({0, 0, 0}, {0, 0, 1}, 40);
  const Vector3 focus(0, 0, 50);
  CHECK_FALSE(form_of(paraboloid_profile(), {0, 0, 50.001}, field));
  CHECK_FALSE(form_of(paraboloid_profile(), {0.001, 0, 50}, field));
  CHECK_FALSE(form_of(Profile::bezier({{0, 100, 1}, {50, 100, 1.0001}, {100, 50, 1}}), focus, field));
  CHECK_FALSE(form_of(Profile::bezier({{0, 100, 1}, {50.01, 100, 1}, {100, 50, 1}}), focus, field));
  CHECK_FALSE(form_of(paraboloid_profile(), focus, field, {0.5, 0.2}));
  CHECK_FALSE(
      form_of(paraboloid_profile(), focus, NearField::disc({0, 0, 0}, {0, 0, 1}, 40, Material::matt(0))));
  CHECK_FALSE(form_of(sphere_profile(), {0, 0, 49}, field));
}
