#include "design/deviations.h"

#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "design/profile_error.h"

namespace catoptric::design {
namespace {

/// First guesses, over the generatrix' extent, or of a radian, of a reflectance, of the power.
constexpr double first_guess_rel = 1e-3;

/// Deviations beyond the part's own size are none.
struct Sizes {
  double extent, unit_mm;  ///< extent in the scene's unit
};

Deviation source_shift(const Scene& scene, const Profile& profile, const Sizes& sizes, std::string name,
                       std::string key, std::string meaning, const Vector3& direction) {
  return {std::move(name),
          std::move(key),
          std::string(symbol(scene.unit)),
          std::move(meaning),
          first_guess_rel * sizes.extent,
          -sizes.extent,
          sizes.extent,
          [=](double shift) -> std::optional<Varied> {
            Varied varied{scene, profile};
            varied.scene.source.position_mm += shift * sizes.unit_mm * direction;
            return varied;
          }};
}

Vector3 across_axis(const sim::NearField& field) {
  Vector3 direction = field.first_axis();
  direction.z() = 0;
  constexpr double hardly_across = 0.1;  // a field that stands upright: any direction will do
  return direction.norm() > hardly_across ? Vector3(direction.normalized()) : Vector3::UnitX();
}

/// `shift` moves the control points by the amplitude times `factor`.
Deviation profile_deviation(const Scene& scene, const std::shared_ptr<const ProfileError>& error,
                            std::vector<PointShift> shift, Deviation described, double factor) {
  described.at = [=, shift = std::move(shift)](double amplitude) -> std::optional<Varied> {
    auto profile = error->at(shift, factor * amplitude);
    if (!profile) return std::nullopt;
    return Varied{scene, std::move(*profile)};
  };
  return described;
}

Deviation normal_mode(const Scene& scene, const std::shared_ptr<const ProfileError>& error, int half_waves,
                      const Sizes& sizes) {
  Deviation described{
      fmt::format("profile, cosine {}", half_waves),
      fmt::format("profile_cosine_{}", half_waves),
      std::string(symbol(scene.unit)),
      half_waves == 0 ? "the whole generatrix moved along its normal, outwards"
                      : fmt::format("the generatrix moved along its normal by cos({} pi s / L), outwards "
                                    "at the vertex; greatest slope error {:.3g} mrad per {}",
                                    half_waves, 1e3 * half_waves * pi / error->length_mm() * sizes.unit_mm,
                                    symbol(scene.unit)),
      first_guess_rel * sizes.extent,
      -sizes.extent,
      sizes.extent,
      {}};
  auto shift = error->along_normal([&](double share) { return std::cos(half_waves * pi * share); });
  return profile_deviation(scene, error, std::move(shift), std::move(described), sizes.unit_mm);
}

Deviation slope(const Scene& scene, const std::shared_ptr<const ProfileError>& error) {
  constexpr double milli = 1e-3;
  Deviation described{"profile, slope",
                      "profile_slope",
                      "mrad",
                      "every slope of the generatrix off by this angle, the vertex in place",
                      first_guess_rel / milli,
                      -pi / 4 / milli,
                      pi / 4 / milli,
                      {}};
  auto shift = error->along_normal([&](double share) { return share * error->length_mm(); });
  return profile_deviation(scene, error, std::move(shift), std::move(described), milli);
}

Deviation reflectance(const Scene& scene, const Profile& profile) {
  const double now = scene.mirror.reflectance;
  return {"reflectance",
          "reflectance",
          "",
          scene.mirror.by_angle ? "the mirror's greatest reflectance, absolute; at other angles in proportion"
                                : "the mirror's reflectance, absolute",
          first_guess_rel,
          -now,
          1 - scene.mirror.diffuse - scene.mirror.transmittance - now,
          [=](double change) -> std::optional<Varied> {
            Varied varied{scene, profile};
            varied.scene.mirror.reflectance = now + change;
            return varied;
          }};
}

Deviation power(const Scene& scene, const Profile& profile) {
  const bool luminous = scene.source.quantity == LightQuantity::luminous;
  return {luminous ? "source flux" : "source power",
          luminous ? "source_flux" : "source_power",
          std::string(flux_unit(scene.source.quantity)),
          luminous ? "the source's luminous flux" : "the source's radiant power",
          first_guess_rel * scene.source.power_w,
          -0.99 * scene.source.power_w,  // a source without power is none
          scene.source.power_w,
          [=](double change) -> std::optional<Varied> {
            Varied varied{scene, profile};
            varied.scene.source.power_w += change;
            return varied;
          }};
}

}  // namespace

std::vector<Deviation> deviations(const Scene& scene, const Profile& profile) {
  const double unit_mm = millimetres_per(scene.unit);
  const Sizes sizes{std::hypot(profile.r_max_mm(), profile.z_max_mm() - profile.z_min_mm()) / unit_mm,
                    unit_mm};
  const auto error = std::make_shared<const ProfileError>(profile);
  std::vector<Deviation> list{
      source_shift(scene, profile, sizes, "source along the axis", "source_axial",
                   "the source moved along the axis, towards greater z", Vector3::UnitZ()),
      source_shift(scene, profile, sizes, "source across the axis", "source_lateral",
                   "the source moved across the axis; shown along that direction",
                   across_axis(scene.near_field))};
  for (int half_waves = 0; half_waves <= scene.sensitivity.modes; ++half_waves)
    list.push_back(normal_mode(scene, error, half_waves, sizes));
  list.push_back(slope(scene, error));
  if (scene.mirror.reflectance > 0) list.push_back(reflectance(scene, profile));
  list.push_back(power(scene, profile));
  return list;
}

}  // namespace catoptric::design
