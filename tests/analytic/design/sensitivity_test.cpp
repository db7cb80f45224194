#include "design/sensitivity.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "design/evaluator.h"
#include "design/field_change.h"
#include "design/profile_error.h"
#include "sim/tubes_jacobian.h"

using namespace catoptric;
using namespace catoptric::design;

namespace {

Scene paper(const std::string& name, const std::vector<Override>& more = {}) {
  std::vector<Override> changes{{"model.replicates", "4", "test"}, {"model.photons", "16384", "test"}};
  changes.insert(changes.end(), more.begin(), more.end());
  return read_scene(std::string(CATOPTRIC_DATA) + "/paper/" + name, changes);
}

const ParameterSensitivity& of(const Sensitivity& sensitivity, const std::string& key) {
  for (const ParameterSensitivity& each : sensitivity.parameters)
    if (each.deviation.key == key) return each;
  throw std::logic_error("no such deviation: " + key);
}

const Sensitivity& paraboloid() {
  static const Sensitivity result = run_sensitivity(paper("paraboloid.toml"), {});
  return result;
}

/// Relative change of the field by a deviation, from photons of two streams that nothing else has used.
double fresh_change(const Scene& scene, const Profile& profile, const Deviation& deviation, double amount) {
  Scene finer = scene;
  finer.model.photons.photons = 1 << 17;
  const auto samples = scene.near_field.samples(scene.samples);
  const auto varied = deviation.at(amount);
  REQUIRE(varied);
  Scene other = varied->scene;
  other.model.photons.photons = 1 << 17;
  const auto before = total_by_rung(finer, sim::Rung::photons, profile, samples, 77);
  const auto after = total_by_rung(other, sim::Rung::photons, varied->profile, samples, 77);
  return root_mean_square_error(after, before) / root_mean_square(before);
}

}  // namespace

TEST_CASE("a profile error moves the curve along its normal by what was asked", "[sensitivity]") {
  const std::vector<Profile> profiles{
      Profile::bezier({{0, 100, 1}, {50, 100, 1}, {100, 50, 1}}),
      Profile::bezier({{0, 100, 1}, {60, 100, 3}, {100, 50, 0.5}}),
      Profile(3, Profile::uniform_knots(3, 6),
              {{0, 100, 1}, {30, 100, 2}, {50, 95, 1}, {80, 80, 1}, {95, 60, 2}, {100, 40, 1}})};
  for (const Profile& profile : profiles)
    for (int half_waves = 0; half_waves <= 4; ++half_waves) {
      INFO("half waves " << half_waves);
      const ProfileError error(profile);
      CHECK(error.length_mm() == Approx(profile.length_mm()).epsilon(1e-6));  // three-point rule, 30 spans
      const auto wanted = [&](double share) { return std::cos(half_waves * pi * share); };
      const auto moved = error.at(error.along_normal(wanted), 1e-3);
      REQUIRE(moved);
      CHECK(moved->at(0).r_mm == 0);
      double length = 0, at = 0, greatest = 0;
      for (int i = 0; i <= 500; ++i) {
        const double u = i / 500.0;
        const MeridianPoint middle = profile.at(0.5 * (at + u)), p = profile.at(u), q = moved->at(u);
        length += (u - at) * std::hypot(middle.dr, middle.dz);
        at = u;
        const double speed = std::hypot(p.dr, p.dz);
        const double normal = (-(q.r_mm - p.r_mm) * p.dz + (q.z_mm - p.z_mm) * p.dr) / speed;
        greatest = std::max(greatest, std::abs(normal / 1e-3 - wanted(length / profile.length_mm())));
      }
      CHECK(greatest < 1e-3);  // of the amplitude; the arc length here is good to 1e-5
    }
}

TEST_CASE("what is proportional comes out exactly: power, reflectance", "[sensitivity][long]") {
  const Sensitivity& s = paraboloid();
  const double power_w = paper("paraboloid.toml").source.power_w;
  const ParameterSensitivity& power = of(s, "source_power");
  CHECK(power.change_per_unit.value_rel == Approx(1 / power_w).epsilon(1e-6));  // tubes' own tolerance
  CHECK(*power.tolerance() == Approx(0.02 * power_w).epsilon(0.005));
  CHECK(power.nonlinearity_rel < 1e-6);
  // All that is reflected was reflected once, so dE/drho is the reflected field.
  const Scene scene = paper("paraboloid.toml");
  const Evaluation field =
      evaluate_by_rung(scene, sim::Rung::tubes, s.profile, scene.near_field.samples(scene.samples), 0);
  const double wanted =
      root_mean_square(field.reflected) / root_mean_square(sum(field.direct, field.reflected));
  const ParameterSensitivity& mirror = of(s, "reflectance");
  CHECK(mirror.change_per_unit.value_rel == Approx(wanted).epsilon(1e-6));
  CHECK_FALSE(mirror.plus);  // a perfect mirror cannot be better
  CHECK(mirror.minus);
}

TEST_CASE("a perfect mirror cannot be better: by photons too it is made worse only", "[sensitivity][long]") {
  const Scene scene = paper("paraboloid.toml", {{"model.rung", "photons", "test"},
                                                {"model.photons", "1024", "test"},
                                                {"sensitivity.modes", "0", "test"}});
  REQUIRE(scene.mirror.reflectance == 1);
  const Sensitivity s = run_sensitivity(scene, {});
  CHECK_FALSE(of(s, "reflectance").plus);
  CHECK(of(s, "reflectance").minus);
}

TEST_CASE("derivatives by profile errors are those that the tubes' own calculus gives",
          "[sensitivity][long]") {
  const Scene scene = paper("start_a.toml", {{"sensitivity.modes", "2", "test"}});
  const Sensitivity s = run_sensitivity(scene, {});
  const ProfileError error(s.profile);
  sim::TubesOptions options;
  options.kernel_radius_mm = *scene.model.estimate.kernel_radius_mm;
  const sim::TubesJacobian exact =
      sim::tubes_jacobian(sim::PointSource(scene.source.position_mm, scene.source.power_w), error.base(),
                          scene.mirror, {0, 1}, s.radii_mm, options);
  for (int half_waves = 0; half_waves <= 2; ++half_waves) {
    const auto shift =
        error.along_normal([&](double t) { return 10 * std::cos(half_waves * pi * t); });  // cm
    Eigen::VectorXd components(exact.by_variable.cols());
    for (std::size_t i = 0; i < shift.size(); ++i)
      components.segment<3>(static_cast<Eigen::Index>(3 * i)) << shift[i].dr_mm, shift[i].dz_mm, 0;
    const Eigen::VectorXd wanted = exact.by_variable * components;
    const auto& got = of(s, "profile_cosine_" + std::to_string(half_waves));
    double difference = 0;
    for (std::size_t i = 0; i < s.radii_mm.size(); ++i)
      difference =
          std::max(difference, std::abs(got.derivative_w_per_mm2[i] - wanted[static_cast<Eigen::Index>(i)]));
    INFO("half waves " << half_waves << ": " << difference / wanted.cwiseAbs().maxCoeff());
    CHECK(difference < 0.01 * wanted.cwiseAbs().maxCoeff());  // the direct light's shadow edge lies elsewhere
  }
}

TEST_CASE("the stated tolerances cost what they say, by fresh photons", "[sensitivity][long]") {
  const Scene scene = paper("paraboloid.toml");
  const Sensitivity& s = paraboloid();
  CHECK(s.budgeted() == s.parameters.size());
  for (const ParameterSensitivity& each : s.parameters)
    for (const auto& side : {each.minus, each.plus}) {
      if (!side) continue;
      INFO(each.deviation.name << " " << side->deviation << " " << each.deviation.unit);
      CHECK(side->change.value_rel == Approx(0.02).epsilon(0.05));
      CHECK(fresh_change(scene, s.profile, each.deviation, side->deviation) == Approx(0.02).epsilon(0.05));
    }
}

TEST_CASE("a source beside the axis needs photons, and tilts the field", "[sensitivity][long]") {
  const ParameterSensitivity& across = of(paraboloid(), "source_lateral");
  CHECK(across.rung == sim::Rung::photons);
  CHECK(across.replicates == 4);
  CHECK(std::abs(across.derivative_w_per_mm2.front()) < 5 * across.derivative_noise_w_per_mm2.front());
  CHECK(*across.tolerance() == Approx(across.plus->deviation).epsilon(0.02));
  CHECK(-across.minus->deviation == Approx(across.plus->deviation).epsilon(0.02));
  CHECK(of(paraboloid(), "source_axial").rung == sim::Rung::tubes);
}

TEST_CASE("noise is taken off a change by photons, and stated", "[sensitivity]") {
  const Scene scene = paper("paraboloid.toml", {{"model.photons", "2048", "test"}});
  const Profile profile = start_profile(scene);
  FieldChanger changer(scene, profile);
  Changes noise;  // of a field that does not change
  noise.w_per_mm2.assign(4, std::vector<double>(scene.near_field.samples(scene.samples).size() + 60));
  std::uint64_t state = 1;
  for (auto& replicate : noise.w_per_mm2)
    for (double& value : replicate) {
      state = state * 6364136223846793005u + 1442695040888963407u;
      value = changer.field_rms_w_per_mm2() * (static_cast<double>(state >> 11) * 0x1p-53 - 0.5);
    }
  const FieldChange change = changer.measure(noise);
  // Not taken off, it would read as 1 / sqrt(12 * 4); what is left is of the order of its fourth root's
  // noise.
  CHECK(change.value_rel < 0.5 / std::sqrt(48.0));
}
