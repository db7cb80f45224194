#include "design/scene_defaults.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/profile.h"
#include "base/profile_limits.h"
#include "cad/profile_import.h"
#include "design/part_settings.h"
#include "design/sampling.h"
#include "design/source_settings.h"
#include "design/surface_settings.h"
#include "design/surroundings_settings.h"
#include "design/target_settings.h"

namespace catoptric::design {
namespace {

std::string list(const std::vector<double>& values) {
  std::string text = "[";
  for (double value : values) text += fmt::format("{}{}", text.size() > 1 ? ", " : "", value);
  return text + "]";
}

void put(Settings& settings, const std::string& path, const std::vector<double>& values,
         const std::string& where) {
  settings.set({path, list(values), where});
}

/// Control points of an imported profile become the scene's own, in its unit, so that scene.toml needs no
/// other file.
std::vector<std::string> resolve_profile_file(Settings& settings) {
  const auto file = settings.text("reflector.profile");
  if (!file || file->empty()) return {};
  for (const char* other : {"reflector.points", "reflector.weights", "reflector.knots", "reflector.degree"})
    if (settings.has(other))
      throw settings.error(other, "the reflector is described twice", "a profile file already gives it",
                           "remove this key or reflector.profile");
  cad::ImportOptions options;
  if (const auto index = settings.integer("reflector.profile_index"))
    options.candidate = static_cast<std::size_t>(*index);
  if (const auto axis = settings.numbers("reflector.profile_axis")) {
    const auto& a = *axis;
    options.axis = cad::Axis{{a[0], a[1], a[2]}, {a[3], a[4], a[5]}};
  }
  const cad::ImportedProfile imported = cad::import_profile(settings.folder() / *file, options);
  const double unit_mm = millimetres_per(scene_unit(settings));
  const double turn = settings.boolean("reflector.profile_upside_down").value_or(false) ? -1.0 : 1.0;
  const double file_apex = turn * imported.profile.points().front().z_mm / unit_mm;
  const double shift = settings.number("reflector.profile_apex").value_or(file_apex) - file_apex;
  std::vector<ControlPoint> control = imported.profile.points();
  for (ControlPoint& point : control) point.z_mm = turn * point.z_mm + shift * unit_mm;
  put_profile(settings, Profile(imported.profile.degree(), imported.profile.knots(), std::move(control)),
              settings.where("reflector.profile"));
  for (const char* used : {"reflector.profile", "reflector.profile_index", "reflector.profile_axis",
                           "reflector.profile_apex", "reflector.profile_upside_down"})
    settings.remove(used);
  std::vector<std::string> notes{fmt::format("generatrix from {}", *file)};
  if (turn < 0) notes.push_back("turned upside down");
  if (shift != 0)
    notes.push_back(fmt::format("moved by {} {} along the axis", shift, symbol(scene_unit(settings))));
  notes.insert(notes.end(), imported.notes.begin(), imported.notes.end());
  return notes;
}

/// Degree, weights and knots of a B-spline written under `table`, from its points.
void complete_spline(Settings& settings, const std::string& table) {
  const auto points = settings.points(table + ".points");
  if (!points || points->empty())
    throw settings.error(table + ".points", "is missing", "a generatrix needs control points",
                         table + ".points = [[0, 10], [5, 10], [10, 5]]");
  const std::size_t count = points->size();
  if (count > most_control_points)
    throw settings.error(table + ".points", fmt::format("{} control points are too many", count),
                         fmt::format("at most {} are taken", most_control_points),
                         "approximate the curve by a spline with fewer");
  settings.fill(table + ".degree", fmt::format("{}", std::clamp<std::size_t>(count - 1, 1, 3)));
  if (!settings.has(table + ".weights")) put(settings, table + ".weights", Numbers(count, 1.0), "default");
  if (!settings.has(table + ".knots")) {
    const int degree = static_cast<int>(*settings.integer(table + ".degree"));
    put(settings, table + ".knots", Profile::uniform_knots(degree, count), "default");
  }
}

void complete_near_field(Settings& settings) {
  const bool disc = settings.text("near_field.shape") == "disc";
  const std::vector<std::string> needed =
      disc ? std::vector<std::string>{"near_field.radius"}
           : std::vector<std::string>{"near_field.width", "near_field.height"};
  for (const std::string& key : needed)
    if (!settings.has(key))
      throw settings.error(key, "is missing", fmt::format("a {} needs it", disc ? "disc" : "rectangle"),
                           key + " = 10");
  const std::vector<std::string> unused =
      disc ? std::vector<std::string>{"near_field.width", "near_field.height"}
           : std::vector<std::string>{"near_field.radius"};
  for (const std::string& key : unused)
    if (settings.has(key))
      throw settings.error(key, "does not belong to this shape", "it would have no effect", "remove it");
  if (!disc) {  // any direction across the normal will do
    const auto n = *settings.numbers("near_field.normal");
    const bool vertical = std::abs(n[0]) <= 0.9 * std::hypot(n[0], n[1], n[2]);
    settings.fill("near_field.along", vertical ? "[1.0, 0.0, 0.0]" : "[0.0, 1.0, 0.0]");
  }
}

void complete_reference(Settings& settings) {
  const std::string kind = *settings.text("target.kind");
  if (kind == "paraboloid") {
    const auto a = settings.number("target.focal_length");
    if (!a)
      throw settings.error("target.focal_length", "is missing", "a paraboloid needs it",
                           "target.focal_length = 5");
    settings.fill("target.rim_radius", fmt::format("{}", 2 * *a));
  }
  if (kind == "reflector") complete_spline(settings, "target");
}

void complete_bandwidth(Settings& settings) {
  if (settings.has("model.neighbours") && settings.has("model.kernel_radius"))
    throw settings.error("model.neighbours", "two bandwidths are given", "an estimate has one",
                         "remove model.neighbours or model.kernel_radius");
  if (settings.has("model.neighbours") || settings.has("model.kernel_radius")) return;
  const double half_width =
      settings.text("near_field.shape") == "disc"
          ? *settings.number("near_field.radius")
          : 0.5 * std::min(*settings.number("near_field.width"), *settings.number("near_field.height"));
  settings.fill("model.kernel_radius", fmt::format("{}", 0.1 * half_width));
}

/// A mirror that is to be made from nothing stands in as a bowl of the right number of points until then.
void complete_start(Settings& settings) {
  const bool tailored = settings.text("start") == "tailored";
  if (!tailored || settings.has("reflector.points")) {
    if (settings.has("tailored.vertex"))
      throw settings.error("tailored.vertex", "has no effect",
                           tailored ? "the reflector is written out" : "start is not \"tailored\"",
                           "remove it, or let the mirror be made from nothing");
    return;
  }
  for (const char* key : {"reflector.degree", "reflector.weights", "reflector.knots"})
    if (settings.has(key))
      throw settings.error(key, "stands alone", "a mirror made from nothing has its own",
                           "tailored.degree and tailored.points");
  const auto given = [&](const char* key) { return settings.has(key); };
  if (!given("tailored.vertex") && !given("constraints.rim_radius_max") &&
      !given("constraints.envelope_radius") && !given("constraints.height_max"))
    throw settings.error("tailored.vertex", "is missing", "a mirror made from nothing needs its size",
                         "constraints.rim_radius_max, constraints.height_max or tailored.vertex");
  const auto degree = *settings.integer("tailored.degree"), count = *settings.integer("tailored.points");
  if (count <= degree)
    throw settings.error("tailored.points", fmt::format("{} are too few for degree {}", count, degree),
                         "a B-spline has more control points than its degree",
                         fmt::format("tailored.points = {}", degree + 1));
  std::string points = "[[0, 1]";
  for (std::int64_t i = 1; i < count; ++i)
    points += fmt::format(", [{}, 1]", static_cast<double>(i) / static_cast<double>(count));
  settings.set({"reflector.points", points + "]", "default"});
  settings.set({"reflector.degree", fmt::format("{}", degree), "default"});
}

}  // namespace

void put_profile(Settings& settings, const Profile& profile, const std::string& where) {
  const double unit_mm = millimetres_per(scene_unit(settings));
  std::string points = "[";
  std::vector<double> weights;
  for (const ControlPoint& point : profile.points()) {
    points +=
        fmt::format("{}[{}, {}]", points.size() > 1 ? ", " : "", point.r_mm / unit_mm, point.z_mm / unit_mm);
    weights.push_back(point.weight);
  }
  settings.set({"reflector.points", points + "]", where});
  settings.set({"reflector.degree", fmt::format("{}", profile.degree()), where});
  put(settings, "reflector.weights", weights, where);
  put(settings, "reflector.knots", profile.knots(), where);
}

LengthUnit scene_unit(const Settings& settings) {
  return parse_length_unit(settings.text("unit").value_or("mm")).value_or(LengthUnit::millimetre);
}

std::vector<std::string> complete(Settings& settings) {
  for (const Key& key : scene_keys())
    if (!key.standard.empty()) settings.fill(std::string(key.path), std::string(key.standard));
  complete_source(settings);
  std::vector<std::string> notes = resolve_profile_file(settings);
  complete_start(settings);
  complete_spline(settings, "reflector");
  complete_part(settings);
  complete_near_field(settings);
  complete_surfaces(settings);
  complete_reference(settings);
  complete_target(settings);
  complete_samples(settings);
  complete_bandwidth(settings);
  complete_surroundings(settings);
  return notes;
}

}  // namespace catoptric::design
