#include "design/tailoring_task.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "base/tolerance.h"
#include "base/units.h"
#include "design/source_settings.h"
#include "sim/source.h"

namespace catoptric::design {
namespace {

/// More of an error than that, by direct light alone, is no design's fault but the target's.
constexpr double most_unreachable_rel = 0.05;
/// Less is not worth a word.
constexpr double worth_telling_rel = 1e-4;

[[noreturn]] void refuse(const Scene& scene, const char* key, std::string what, std::string why,
                         std::string hint) {
  throw scene.settings.error(key, what, why, hint);
}

void check_symmetry(const Scene& scene, double apex_side) {
  const Vector3 source = scene.source.position_mm, normal = scene.near_field.normal();
  const double reach_mm = std::max(scene.near_field.half_width_mm(), scene.near_field.half_height_mm());
  if (std::hypot(source.x(), source.y()) > Tolerance::for_scale(reach_mm).length_mm)
    refuse(scene, "source.position", "a tailored start needs the source on the axis",
           "its flux balance counts rings about the z axis", "start = \"profile\"");
  if (!far_exponent(scene.source))
    refuse(scene, "source.kind",
           "a tailored start needs light like a power of the cosine, or the same in all directions",
           "its flux balance knows no other", "start = \"profile\", or a disc or sphere in its place");
  if (const auto shining = make_source(scene.source);
      !shining->is_round() || shining->tilt_rad() > Tolerance::for_scale(1).angle_rad)
    refuse(scene, "source.axis", "a tailored start needs a source that shines alike round the axis",
           "its flux balance counts rings about the z axis", "start = \"profile\"");
  for (const optim::Variable& variable : scene.variables)
    if (parse_scene_variable(variable.name))
      refuse(scene, "start", "a tailored start moves the mirror's shape alone",
             variable.name + " is no part of it", "start = \"profile\"");
  if (std::hypot(normal.x(), normal.y()) > Tolerance::for_scale(1).angle_rad)
    refuse(scene, "near_field.normal", "a tailored start needs the near field across the axis",
           "its flux balance counts rings about the z axis", "start = \"profile\"");
  if (normal.z() * apex_side < 0)
    refuse(scene, "near_field.normal", "the near field looks away from the mirror",
           "light from the mirror would arrive at its back", "turn the normal over");
  if (scene.mirror.by_angle)
    refuse(scene, scene.settings.has("reflector.index") ? "reflector.index" : "reflector.angles",
           "a tailored start needs one reflectance for all angles",
           "its flux balance is made before the mirror, whose angles nobody knows then",
           "reflector.reflectance for the tailored mirror; then a search from it with the angles");
  if (scene.mirror.diffuse > 0)
    refuse(scene, "reflector.diffuse", "a tailored start needs a mirror that is not matt",
           "its flux balance follows single rays", "reflector.diffuse = 0, then a search from that mirror");
  if (!(scene.mirror.reflectance > 0))
    refuse(scene, "reflector.reflectance", "a mirror that reflects nothing cannot be tailored", "",
           "reflectance = 0.9");
}

/// Root mean square over the area, of light at so many radii.
template <typename Light>
double area_rms(double reach_mm, const Light& light) {
  constexpr int count = 400;
  double sum = 0;
  for (int i = 0; i < count; ++i) {
    const double value = light(reach_mm * std::sqrt((i + 0.5) / count));
    sum += value * value / count;
  }
  return std::sqrt(sum);
}

class Maker {
 public:
  Maker(const Scene& scene, double apex_side) : scene_(scene), target_(target_of(scene)) {
    check_symmetry(scene, apex_side);
    layout_ = {scene.source.position_mm.z(), scene.near_field.center_mm().z(), apex_side};
    flux_ =
        polar_flux(scene.source.power_w, *far_exponent(scene.source), scene.source.axis.z() * apex_side > 0);
    const std::shared_ptr<sim::Source> source = make_source(scene.source);
    direct_ = [source, z_mm = layout_.field_z_mm, normal = scene.near_field.normal()](double radius_mm) {
      return source->unhindered_w_per_mm2({radius_mm, 0, z_mm}, normal);
    };
  }

  TailoringTask make() {
    double level = 1;
    std::vector<std::string> notes;
    if (scene_.target.free_scale) level = free_level(notes);
    if (scene_.mirror.roughness > 0)
      notes.push_back("the mirror is made as if it were smooth; its roughness then blurs the light");
    WantedLight wanted = wanted_at(level);
    const double unreachable = check_direct(level, notes);
    FluxMap map(flux_, scene_.mirror.reflectance, wanted);
    check_power(map);
    const auto total = [level, all = target_.total_w_per_mm2, end_mm = target_.reach_mm](double radius_mm) {
      return radius_mm <= end_mm ? level * all(radius_mm) : 0.0;
    };
    return {layout_, flux_, std::move(map), std::move(wanted), total, level, unreachable, std::move(notes)};
  }

 private:
  static RadialTarget target_of(const Scene& scene) {
    auto target = radial_target(scene);
    if (target) return std::move(*target);
    refuse(scene, "target.kind", "a tailored start needs a target that depends on the radius alone",
           "its flux balance counts rings about the z axis",
           "target.kind = \"uniform\", \"ring\", \"zones\", \"gaussian\", \"radial\" or \"paraboloid\"");
  }

  WantedLight wanted_at(double level) const {
    return {[level, total = target_.total_w_per_mm2, direct = direct_](double radius_mm) {
              return level * total(radius_mm) - direct(radius_mm);
            },
            target_.jumps_mm, target_.reach_mm};
  }

  /// The level at which the mirror within the rim angle asked for has just enough light.
  double free_level(std::vector<std::string>& notes) const {
    const double available = scene_.mirror.reflectance * flux_.within_w(scene_.tailored.rim_angle_rad);
    // Direct light in excess of the target makes the flux bend with the level: a few secants straighten it.
    double level = 1;
    const auto flux_at = [&](double at) { return FluxMap(flux_, 1.0, wanted_at(at)).wanted_w(); };
    const double shape = power_of(target_.total_w_per_mm2);
    for (int i = 0; i < 20; ++i) level += (available - flux_at(level)) / shape;
    notes.push_back(fmt::format(
        "the target's level is {:.6g} times what is written, so that the mirror's light up to {:.4g} degrees "
        "fills it",
        level, scene_.tailored.rim_angle_rad * 180 / pi));
    return level;
  }

  double power_of(const std::function<double(double)>& light) const {
    WantedLight all{light, target_.jumps_mm, target_.reach_mm};
    return FluxMap(flux_, 1.0, all).wanted_w();
  }

  double check_direct(double level, std::vector<std::string>& notes) const {
    double worst = 0, worst_mm = 0;
    const double excess = area_rms(target_.reach_mm, [&](double radius_mm) {
      const double over = std::max(0.0, direct_(radius_mm) - level * target_.total_w_per_mm2(radius_mm));
      if (over > worst) {
        worst = over;
        worst_mm = radius_mm;
      }
      return over;
    });
    const double rms = area_rms(target_.reach_mm,
                                [&](double radius_mm) { return level * target_.total_w_per_mm2(radius_mm); });
    const double relative = rms > 0 ? excess / rms : HUGE_VAL;
    if (relative <= worth_telling_rel) return relative;
    const std::string what = fmt::format(
        "the source alone gives up to {:.4g} {} more than the target wants, at {:.4g} {} from the axis",
        to_w_per_m2(worst), irradiance_unit(scene_.source.quantity), scene_.to_scene_unit(worst_mm),
        symbol(scene_.unit));
    const std::string why = fmt::format(
        "no mirror takes light away: the relative error cannot fall below {:.2g} %", 100 * relative);
    if (relative > most_unreachable_rel)
      refuse(scene_, "target.kind", what, why, "want more light there, or move the source farther away");
    notes.push_back(what + ": " + why);
    return relative;
  }

  void check_power(const FluxMap& map) const {
    const double most_w = map.available_w(pi);
    if (map.wanted_w() < most_w) return;
    const std::string_view unit = flux_unit(scene_.source.quantity);
    refuse(scene_, power_key(scene_.source.quantity),
           fmt::format("the target wants {:.4g} {} from the mirror, which can have {:.4g} {} at most",
                       map.wanted_w(), unit, most_w, unit),
           fmt::format("the source sends {:.4g} {} in all directions, and the mirror reflects {:.4g} of it",
                       scene_.source.power_w, unit, scene_.mirror.reflectance),
           "want less light, a smaller field, or only the shape: target.scale = \"free\"");
  }

  const Scene& scene_;
  RadialTarget target_;
  AxialLayout layout_{};
  PolarFlux flux_;
  std::function<double(double)> direct_;
};

}  // namespace

TailoringTask tailoring_task(const Scene& scene, double apex_side) { return Maker(scene, apex_side).make(); }

}  // namespace catoptric::design
