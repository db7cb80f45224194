#include "design/tailored_start.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <variant>

#include "base/units.h"
#include "design/compensation.h"
#include "design/design_space.h"
#include "design/free_profile.h"
#include "design/profile_fit.h"
#include "design/run.h"
#include "design/tailoring.h"
#include "design/tailoring_task.h"
#include "design/variables.h"
#include "sim/tubes.h"

namespace catoptric::design {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

ProfileVariables variables_of(std::shared_ptr<const FreeProfile> family) {
  return {family->variables(), [family](std::span<const double> x) { return family->at(x); },
          [family](const Profile& profile) { return family->chain(profile); }};
}

/// All of the scene's generatrix, from where its listed variables start it.
ProfileVariables whole_profile(const Scene& scene) {
  const Profile start = start_profile(scene);
  SearchSpec search;
  search.free = Freedom::profile;
  search.free_profile = package_about(start, scene.unit);
  search.free_profile.hold_vertex = scene.settings.boolean("search.hold_vertex").value_or(false);
  std::vector<optim::Variable> shape_only;
  for (const optim::Variable& each : scene.variables)
    if (!parse_scene_variable(each.name)) shape_only.push_back(each);
  ProfileVariables family = variables_of(std::make_shared<FreeProfile>(start, search.free_profile));
  family.variables = free_variables(start, search, shape_only);
  return family;
}

/// The scene's listed variables; weights by their logarithms, lengths in mm.
ProfileVariables listed_variables(const Scene& scene) {
  const double unit_mm = millimetres_per(scene.unit);
  std::vector<std::string> names;
  std::vector<Component> components;
  ProfileVariables family;
  for (optim::Variable variable : scene.variables) {
    if (parse_scene_variable(variable.name)) continue;  // the light is balanced for the scene as written
    names.push_back(variable.name);
    components.push_back(*parse_component(variable.name, scene.profile.points().size()));
    const bool weight = components.back().coordinate == 'w';
    variable.step = weight ? std::log1p(variable.step / variable.start) : variable.step * unit_mm;
    for (double* each : {&variable.start, &variable.lower, &variable.upper})
      *each = weight ? std::log(*each) : *each * unit_mm;
    family.variables.push_back(variable);
  }
  const auto profiles = std::make_shared<ProfileFamily>(scene.profile, names, LengthUnit::millimetre);
  family.at = [profiles, components](std::span<const double> x) {
    std::vector<double> values(x.begin(), x.end());
    for (std::size_t i = 0; i < values.size(); ++i)
      if (components[i].coordinate == 'w') values[i] = std::exp(values[i]);
    return profiles->at(values);
  };
  family.chain = [components](const Profile& profile) {
    Eigen::MatrixXd chain = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(3 * profile.points().size()),
                                                  static_cast<Eigen::Index>(components.size()));
    for (std::size_t i = 0; i < components.size(); ++i) {
      const auto place = static_cast<Eigen::Index>(3 * components[i].point +
                                                   std::string_view("rzw").find(components[i].coordinate));
      chain(place, static_cast<Eigen::Index>(i)) =
          components[i].coordinate == 'w' ? profile.points()[components[i].point].weight : 1.0;
    }
    return chain;
  };
  return family;
}

/// How far the light of a mirror is from what is wanted of it, relative, by ray tubes at radii away from
/// jumps.
double light_error_rel(const Scene& scene, const TailoringTask& task, const Profile& profile) {
  constexpr int count = 64;
  constexpr double margin = 0.02;  // of the reach, about a jump
  std::vector<double> radii;
  for (int i = 0; i < count; ++i) {
    const double radius_mm = task.wanted.end_mm * std::sqrt((i + 0.5) / count);
    const bool near_jump = std::ranges::any_of(task.wanted.breaks_mm, [&](double jump_mm) {
      return std::abs(radius_mm - jump_mm) < margin * task.wanted.end_mm;
    });
    if (!near_jump) radii.push_back(radius_mm);
  }
  double square = 0, wanted_square = 0, peak = 0;
  for (const double radius_mm : radii) peak = std::max(peak, task.wanted.w_per_mm2(radius_mm));
  sim::TubesOptions options;
  options.pointwise_tolerance_w_per_mm2 = 1e-4 * peak;
  options.most_rays = 4096;  // twenty times what a mirror without folds takes; of others a rough idea will do
  options.most_meetings = 65536;
  const sim::PointSource source(scene.source.position_mm, scene.source.power_w, *far_exponent(scene.source),
                                scene.source.axis);
  const sim::FieldPlane plane{task.layout.field_z_mm, scene.near_field.normal().z() > 0};
  const sim::TubesField field = sim::tubes_field(source, profile, scene.mirror, plane, radii, options);
  for (std::size_t i = 0; i < radii.size(); ++i) {
    const double wanted = std::max(0.0, task.wanted.w_per_mm2(radii[i]));
    // A caustic counts as a ten times too bright place, not as infinitely wrong.
    const double off = std::min(field.irradiance[i], 10 * peak) - wanted;
    square += off * off;
    wanted_square += wanted * wanted;
  }
  return std::sqrt(square / wanted_square);
}

/// Mirrors made from nothing, by one of the ray maps.
class MirrorFactory {
 public:
  MirrorFactory(const Scene& scene, const TailoringTask& task, RayMap kind)
      : scene_(scene), task_(task), kind_(kind) {}

  /// A sentence where this map makes no mirror for the light.
  std::variant<Tailored, std::string> make(const FluxMap& map) const {
    const auto vertex = apex_distance_mm(map);
    if (const auto* why = std::get_if<std::string>(&vertex)) return *why;
    double apex_mm = std::get<double>(vertex), overshoot = 0;
    constexpr int most_tries = 4;  // a spline goes its own way where its points do not suffice for the curve
    for (int i = 0; i < most_tries; ++i) {
      auto made = make_at(map, apex_mm);
      const auto* tailored = std::get_if<Tailored>(&made);
      if (!tailored || scene_.tailored.vertex_mm) return made;
      overshoot = share_of_package(tailored->profile);
      if (overshoot <= 1) return made;
      apex_mm *= room / overshoot;
    }
    return fmt::format("a spline of {} points leaves the package by {:.2g} %", scene_.tailored.points,
                       100 * (overshoot - 1));
  }

 private:
  /// What is left of the package for the curve: the spline goes beside it by less than that.
  static constexpr double room = 1 - 1e-4;

  std::variant<Tailored, std::string> make_at(const FluxMap& map, double apex_mm) const {
    const int degree = scene_.tailored.degree;
    const std::size_t points = scene_.tailored.points;
    const auto curve = curve_from(map, apex_mm, 20 * points);
    if (const auto* why = std::get_if<std::string>(&curve)) return *why;
    std::vector<double> breaks = map.break_angles_rad();
    for (double& each : breaks) each /= map.last_angle_rad();
    const std::vector<double> knots = knots_with_breaks(degree, points, breaks);
    auto control = fit_control_points(std::get<0>(curve), degree, knots);
    control[0].z_mm = std::get<0>(curve).front().z_mm;
    if (begins_smooth(std::get<0>(curve))) control[1].z_mm = control[0].z_mm;
    if (const auto defect = Profile::find_defect(degree, knots, control)) return defect->what;
    FreeProfileOptions options;
    options.hold_vertex = true;
    const ProfileVariables family =
        variables_of(std::make_shared<FreeProfile>(Profile(degree, knots, control), options));
    TailoringOptions search;
    search.most_restarts = 0;  // the fit is where a search should begin
    search.value_tolerance = 1e-4;
    return tailor(map, task_.layout, kind_, family, search);
  }

  double most_radius_mm() const {
    const Constraints& package = scene_.constraints;
    return std::min(package.rim_radius_max_mm.value_or(HUGE_VAL),
                    package.envelope_radius_mm.value_or(HUGE_VAL));
  }
  double most_height_mm() const { return scene_.constraints.height_max_mm.value_or(HUGE_VAL); }

  /// How much of the package a mirror takes in the direction in which it takes most: beyond 1 it does not
  /// fit.
  double share_of_package(const Profile& profile) const {
    return std::max(profile.r_max_mm() / most_radius_mm(),
                    (profile.z_max_mm() - profile.z_min_mm()) / most_height_mm());
  }

  std::variant<std::vector<CurvePoint>, std::string> curve_from(const FluxMap& map, double apex_mm,
                                                                std::size_t points) const {
    std::vector<double> angles;
    for (std::size_t i = 1; i <= points; ++i)
      angles.push_back(map.last_angle_rad() * static_cast<double>(i) / static_cast<double>(points));
    return tailored_curve(map, task_.layout, kind_, apex_mm, angles);
  }

  /// As wished, or as large as the package allows: a larger mirror makes the same light, and less of a source
  /// that is no point shows in it.
  std::variant<double, std::string> apex_distance_mm(const FluxMap& map) const {
    if (scene_.tailored.vertex_mm) return *scene_.tailored.vertex_mm;
    const double radius_mm = most_radius_mm(), height_mm = most_height_mm();
    const auto fits = [&](double apex_mm) {
      const auto curve = curve_from(map, apex_mm, 40);
      if (!std::holds_alternative<std::vector<CurvePoint>>(curve)) return false;
      double r_most = 0, z_least = HUGE_VAL, z_most = -HUGE_VAL;
      for (const CurvePoint& point : std::get<0>(curve)) {
        r_most = std::max(r_most, point.r_mm);
        z_least = std::min(z_least, point.z_mm);
        z_most = std::max(z_most, point.z_mm);
      }
      return r_most <= room * radius_mm && z_most - z_least <= room * height_mm;
    };
    // The package's own size is more than any mirror in it needs; below a ten thousandth there is none.
    double most = std::min(radius_mm, height_mm), least = 1e-4 * most;
    if (fits(most)) return most;
    if (!fits(least))
      return fmt::format("no mirror of this kind fits a package of radius {:.4g} and height {:.4g} {}",
                         scene_.to_scene_unit(radius_mm), scene_.to_scene_unit(height_mm),
                         symbol(scene_.unit));
    for (int i = 0; i < 40; ++i) {
      const double middle = std::sqrt(least * most);
      (fits(middle) ? least : most) = middle;
    }
    return least;
  }

  const Scene& scene_;
  const TailoringTask& task_;
  RayMap kind_;
};

/// A mirror from nothing with what decides between the maps.
struct Made {
  Tailored tailored;
  RayMap kind;
  double light_error_rel;
};

/// Takes the mirror for the point source to one for the real source, and says what is possible.
void serve_extended_source(const Scene& scene, TailoringTask& task, Made& made) {
  const ImageRange images = source_images(task.layout, scene.source.radius_mm, made.tailored.profile);
  const MirrorFactory factory(scene, task, made.kind);
  const auto make = [&](const WantedLight& wanted) -> std::optional<Profile> {
    const FluxMap map(task.flux, scene.mirror.reflectance, wanted);
    if (!(map.wanted_w() < map.available_w(pi))) return std::nullopt;
    auto mirror = factory.make(map);
    if (auto* tailored = std::get_if<Tailored>(&mirror)) return std::move(tailored->profile);
    return std::nullopt;
  };
  Compensated found = compensate(scene, task, made.tailored.profile, images.least_mm, make);
  task.notes.push_back(fmt::format(
      "the source is no point: its images on the near field are {:.3g} to {:.3g} {} in radius, and no edge "
      "of "
      "the light is sharper than the smallest of them. A point source's mirror is off by {:.2g} %, the best "
      "of "
      "{} compensated ones by {:.2g} % (noise {:.1g} %); light made of such images comes to {:.2g} % at best",
      scene.to_scene_unit(images.least_mm), scene.to_scene_unit(images.most_mm), symbol(scene.unit),
      100 * found.first_error_rel, found.mirrors, 100 * found.error_rel, 100 * found.noise_rel,
      100 * found.limit_rel));
  if (found.objection)
    task.notes.push_back(
        fmt::format("these mirrors were lit as if nothing stood between them and a bare plane, since {}; "
                    "what stands there "
                    "is in the verdict",
                    *found.objection));
  made.tailored.profile = std::move(found.profile);
}

/// Without the time it took: results repeat bit for bit.
std::string miss_in_words(const TailoredStart& start) {
  std::string words = fmt::format(
      "tailored by the {} ray map: rays miss their places by {:.2g} rad, {} evaluations from {} {}",
      name(start.map), start.miss_rad, start.evaluations, start.starts,
      start.starts == 1 ? "start" : "starts");
  if (start.light_error_rel)
    words += fmt::format("; a point source's light from it is off by {:.2g} %, by ray tubes without a kernel",
                         100 * *start.light_error_rel);
  return words;
}

TailoredStart result(TailoringTask task, Tailored tailored, RayMap kind, Clock::time_point begin,
                     std::optional<double> light_error_rel = {}) {
  TailoredStart start{std::move(tailored.profile),
                      kind,
                      tailored.miss_rad,
                      task.map.last_angle_rad(),
                      task.level,
                      task.unreachable_rel,
                      light_error_rel,
                      tailored.evaluations,
                      tailored.starts,
                      0,
                      std::move(task.notes)};
  start.seconds = seconds_since(begin);
  start.notes.push_back(miss_in_words(start));
  return start;
}

std::vector<RayMap> wished_maps(const Scene& scene) {
  if (scene.tailored.map) return {*scene.tailored.map};
  return {RayMap::diverging, RayMap::crossing};
}

}  // namespace

TailoredStart tailored_variables(const Scene& scene) {
  const auto begin = Clock::now();
  const double apex = scene.profile.points().front().z_mm - scene.source.position_mm.z();
  TailoringTask task = tailoring_task(scene, apex < 0 ? -1 : 1);
  const bool whole = scene.settings.text("search.free") == "profile";
  const ProfileVariables family = whole ? whole_profile(scene) : listed_variables(scene);
  if (family.variables.empty())
    throw scene.settings.error("start", "there is nothing to tailor", "no variable moves the mirror's shape",
                               "[variables.w1], or search.free = \"profile\", or no reflector.points");
  std::optional<Tailored> best;
  RayMap kind{};
  long evaluations = 0;
  int starts = 0;
  for (const RayMap each : wished_maps(scene)) {
    Tailored tailored = tailor(task.map, task.layout, each, family);
    evaluations += tailored.evaluations;
    starts += tailored.starts;
    if (best && !(tailored.miss_rad < best->miss_rad)) continue;
    const bool exact = tailored.miss_rad <= TailoringOptions{}.reach_rad;
    best = std::move(tailored);
    kind = each;
    if (exact) break;
  }
  best->evaluations = evaluations;
  best->starts = starts;
  return result(std::move(task), std::move(*best), kind, begin);
}

TailoredStart tailored_from_nothing(const Scene& scene) {
  const auto begin = Clock::now();
  const double apex_side = scene.source.position_mm.z() < scene.near_field.center_mm().z() ? -1 : 1;
  TailoringTask task = tailoring_task(scene, apex_side);
  std::optional<Made> best;
  std::string why_not;
  for (const RayMap kind : wished_maps(scene)) {
    auto made = MirrorFactory(scene, task, kind).make(task.map);
    if (const auto* why = std::get_if<std::string>(&made)) {
      why_not += fmt::format("{}{}: {}", why_not.empty() ? "" : "; ", name(kind), *why);
      continue;
    }
    Made candidate{std::get<Tailored>(std::move(made)), kind, 0};
    candidate.light_error_rel = light_error_rel(scene, task, candidate.tailored.profile);
    if (!best || candidate.light_error_rel < best->light_error_rel) best = std::move(candidate);
  }
  if (!best)
    throw scene.settings.error("start", "no tailored mirror reaches this target", why_not,
                               "another tailored.vertex, a larger package, or a smaller field");
  if (scene.source.radius_mm > 0) serve_extended_source(scene, task, *best);
  return result(std::move(task), std::move(best->tailored), best->kind, begin,
                scene.source.radius_mm > 0 ? std::nullopt : std::optional(best->light_error_rel));
}

}  // namespace catoptric::design
