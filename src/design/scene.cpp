#include "design/scene.h"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

#include "base/profile_limits.h"
#include "base/tolerance.h"
#include "base/units.h"
#include "design/constraint_settings.h"
#include "design/design_space.h"
#include "design/landscape_settings.h"
#include "design/part_settings.h"
#include "design/refinement.h"
#include "design/run.h"
#include "design/scene_defaults.h"
#include "design/search.h"
#include "design/source_settings.h"
#include "design/surface_settings.h"
#include "design/tailored_settings.h"
#include "design/target_settings.h"
#include "design/variables.h"

namespace catoptric::design {
namespace {

Vector3 vector(const Settings& settings, const char* path, double factor = 1.0) {
  const Numbers v = *settings.numbers(path);
  return factor * Vector3(v[0], v[1], v[2]);
}

/// A direction that the user wrote: any length but zero.
Vector3 direction(const Settings& settings, const char* path) {
  const Vector3 v = vector(settings, path);
  require_direction(settings, path, v);
  return v;
}

Profile profile(const Settings& settings, const std::string& table, double unit_mm) {
  const Points points = *settings.points(table + ".points");
  const Numbers weights = *settings.numbers(table + ".weights");
  if (weights.size() != points.size())
    throw settings.error(table + ".weights",
                         fmt::format("{} weights for {} points", weights.size(), points.size()),
                         "each control point has one weight", "leave the weights out to have them all 1");
  std::vector<ControlPoint> control;
  for (std::size_t i = 0; i < points.size(); ++i)
    control.push_back({points[i][0] * unit_mm, points[i][1] * unit_mm, weights[i]});
  const int degree = static_cast<int>(*settings.integer(table + ".degree"));
  const Numbers knots = *settings.numbers(table + ".knots");
  if (const auto defect = Profile::find_defect(degree, knots, control))
    throw settings.error(table + ".points", defect->what, defect->why, defect->hint);
  if (const double ratio = weight_ratio(degree, control); ratio > greatest_weight_ratio)
    throw settings.error(table + ".weights",
                         fmt::format("weights act on one span that differ by {:.3g}", ratio),
                         fmt::format("they may differ by {:g}; beyond that a span's ends have too few digits",
                                     greatest_weight_ratio),
                         "bring them nearer; there the curve follows its control polygon in any case");
  return Profile(degree, knots, std::move(control));
}

sim::NearField near_field(const Settings& settings, double unit_mm) {
  const Vector3 center_mm = vector(settings, "near_field.center", unit_mm);
  const Vector3 normal = direction(settings, "near_field.normal");
  const std::optional<sim::Material> surface = near_field_material(settings);
  if (settings.text("near_field.shape") == "disc")
    return sim::NearField::disc(center_mm, normal, *settings.number("near_field.radius") * unit_mm, surface);
  const Vector3 along = direction(settings, "near_field.along");
  if (along.normalized().cross(normal.normalized()).norm() <
      1e-6)  // rad: no plane direction is left below that
    throw settings.error("near_field.along", "is parallel to the normal", "it must lie across it",
                         "[1, 0, 0]");
  return sim::NearField::rectangle(center_mm, normal, along, *settings.number("near_field.width") * unit_mm,
                                   *settings.number("near_field.height") * unit_mm, surface);
}

/// Eq. 12 and 13 hold for a source on the axis and a near field across it.
void check_paraboloid(const Settings& settings, const SourceSpec& source, const sim::NearField& field) {
  const bool on_axis = source.position_mm.x() == 0 && source.position_mm.y() == 0;
  const bool across = std::abs(std::abs(field.normal().z()) - 1) < 1e-12;  // roundings of a unit vector
  const bool even = source.kind == SourceKind::point && source.exponent == 0;
  if (!on_axis || !across || !even)
    throw settings.error("target.kind", "the paraboloid's formulas do not hold here",
                         "eq. 12 and 13 need a point source, alike in all directions, on the z axis and the "
                         "near field across it",
                         "target.kind = \"reflector\" with the paraboloid's control points");
}

TargetSpec target(const Settings& settings, double unit_mm, const sim::NearField& field) {
  std::optional<Profile> reference;
  if (settings.text("target.kind") == "reflector") reference = profile(settings, "target", unit_mm);
  TargetSpec spec = target_spec(settings, unit_mm, std::move(reference));
  check_across_axis(settings, spec, field);
  add_field_notes(spec, field);
  return spec;
}

ModelSpec model(const Settings& settings, double unit_mm) {
  ModelSpec spec{};
  const std::string rung = *settings.text("model.rung");
  spec.rung = sim::parse_rung(rung);
  const std::string engine = *settings.text("model.engine");
  spec.engine = engine == "occt" ? Engine::occt : engine == "mesh" ? Engine::mesh : Engine::meridian;
  spec.mesh.chord_error = *settings.number("model.chord_error");
  spec.mesh.newton_tolerance = *settings.number("model.newton_tolerance");
  spec.engine_asked_for = engine != "auto";
  spec.photons.photons = static_cast<std::uint64_t>(*settings.integer("model.photons"));
  spec.photons.sampler =
      settings.text("model.sampler") == "sobol" ? sim::Sampler::sobol : sim::Sampler::random;
  spec.photons.seed = static_cast<std::uint64_t>(*settings.integer("seed"));
  spec.photons.most_interactions = static_cast<int>(*settings.integer("model.interactions"));
  spec.estimate.kernel = *sim::parse_kernel(*settings.text("model.kernel"));
  if (const auto n = settings.integer("model.neighbours"))
    spec.estimate.neighbours = static_cast<std::size_t>(*n);
  if (const auto r = settings.number("model.kernel_radius")) spec.estimate.kernel_radius_mm = *r * unit_mm;
  spec.replicates = static_cast<std::uint64_t>(*settings.integer("model.replicates"));
  spec.most_photons = static_cast<std::uint64_t>(*settings.integer("model.most_photons"));
  return spec;
}

Metric metric(const std::string& text) {
  for (Metric each : {Metric::relative_rmse, Metric::enclosed_flux, Metric::uniformity, Metric::efficiency,
                      Metric::intensity_rmse, Metric::diversity, Metric::relative_intensity_rmse})
    if (text == name(each)) return each;
  return Metric::rmse;
}

SearchSpec search(const Settings& settings, double unit_mm) {
  Numbers kernels_mm = settings.numbers("search.kernels").value_or(Numbers{});
  for (double& kernel : kernels_mm) kernel *= unit_mm;
  return {*settings.text("search.method"),
          metric(*settings.text("search.metric")),
          *settings.number("search.acceleration"),
          *settings.number("search.reduction"),
          *settings.number("search.smallest_step"),
          static_cast<long>(*settings.integer("search.most_evaluations")),
          static_cast<long>(*settings.integer("search.most_iterations")),
          static_cast<int>(*settings.integer("search.population")),
          static_cast<long>(*settings.integer("search.restarts")),
          settings.number("search.reach"),
          std::move(kernels_mm)};
}

/// What a search moves where not only listed components are free: taken from the profile with the listed
/// variables at their starts, which becomes the scene's.
void set_free(const Settings& settings, SearchSpec& spec, Profile& base,
              std::vector<optim::Variable>& variables, LengthUnit unit) {
  const std::string free = *settings.text("search.free");
  spec.free = free == "profile"     ? Freedom::profile
              : free == "curvature" ? Freedom::curvature
                                    : Freedom::listed;
  spec.refine = *settings.texts("search.refine");
  if (!spec.refine.empty() && spec.free != Freedom::profile)
    throw settings.error("search.refine", "there is no freedom to gain",
                         "refinement adds control points, which only a free profile moves",
                         "search.free = \"profile\"");
  if (spec.free == Freedom::listed) return;
  std::vector<std::string> moved;
  std::vector<double> values;
  for (const optim::Variable& variable : variables)
    if (!parse_scene_variable(variable.name)) {
      moved.push_back(variable.name);
      values.push_back(variable.start);
    }
  const auto start = ProfileFamily(base, moved, unit).at(values);
  if (!start)
    throw settings.error("search.free", "the start values make no mirror",
                         "the generatrix must stay in the half-plane r >= 0", "move the start values");
  base = *start;
  spec.free_profile = package_about(base, unit);
  spec.free_profile.hold_vertex = spec.curvature.hold_vertex = *settings.boolean("search.hold_vertex");
  spec.curvature.unit = unit;
  spec.curvature.degree = std::max(spec.curvature.degree, base.degree());
  spec.curvature.stations = static_cast<int>(*settings.integer("search.curvature_stations"));
  try {
    variables = free_variables(base, spec, variables);
    Profile finer = base;
    for (const std::string& step : spec.refine) finer = refined(finer, step);
  } catch (const InputError& error) {
    throw settings.error(spec.refine.empty() ? "search.free" : "search.refine", error.parts().what,
                         error.parts().why, error.parts().hint);
  }
}

double start_of(const std::string& name, const Candidate& base, LengthUnit unit) {
  if (const auto beside = parse_scene_variable(name)) return scene_value(base, *beside, unit);
  return component_value(base.profile, *parse_component(name, base.profile.points().size()), unit);
}

/// Bounds of weights, and of what belongs to the scene.
void check_bounds(const Settings& settings, const optim::Variable& variable, const Candidate& base) {
  const std::string path = "variables." + variable.name;
  if (const auto beside = parse_scene_variable(variable.name)) {
    for (const auto& [key, value] : {std::pair{".lower", variable.lower}, {".upper", variable.upper}})
      if (const auto defect = value_defect(base, *beside, value))
        throw settings.error(path + key, fmt::format("{} is no bound for it", value), *defect, "");
    return;
  }
  const Component component = *parse_component(variable.name, base.profile.points().size());
  if (component.coordinate == 'w' && variable.lower < least_weight)
    throw settings.error(path + ".lower", fmt::format("{} is no lower bound for a weight", variable.lower),
                         fmt::format("weights lie between {} and {}", least_weight, greatest_weight), "0.05");
  if (component.coordinate == 'w' && variable.upper > greatest_weight)
    throw settings.error(path + ".upper", fmt::format("{} is no upper bound for a weight", variable.upper),
                         fmt::format("weights lie between {} and {}", least_weight, greatest_weight), "20");
}

/// Decision variables in the order of the design vector, not of the file; those beside the shape come last.
std::vector<optim::Variable> variables(Settings& settings, const Candidate& base, LengthUnit unit) {
  std::vector<std::string> names = settings.names_under("variables");
  const std::size_t points = base.profile.points().size();
  for (const std::string& name : names)
    if (!is_variable(name, base))
      throw settings.error("variables." + name + ".step", "is no variable of this reflector",
                           variables_rule(base), "count control points from 0");
  const auto place = [&](const std::string& name) {
    if (const auto beside = parse_scene_variable(name)) return 3 * points + static_cast<std::size_t>(*beside);
    const Component component = *parse_component(name, points);
    return 3 * component.point + std::string_view("rzw").find(component.coordinate);
  };
  std::sort(names.begin(), names.end(), [&](const auto& a, const auto& b) { return place(a) < place(b); });

  std::vector<optim::Variable> list;
  for (const std::string& name : names) {
    const std::string path = "variables." + name;
    for (const char* needed : {".step", ".lower", ".upper"})
      if (!settings.has(path + needed))
        throw settings.error(path + needed, "is missing", "a variable needs step, lower and upper",
                             path + needed + " = 1");
    if (!settings.has(path + ".start"))
      settings.set({path + ".start", fmt::format("{}", start_of(name, base, unit)), "default"});
    optim::Variable variable{name, *settings.number(path + ".start"), *settings.number(path + ".step"),
                             *settings.number(path + ".lower"), *settings.number(path + ".upper")};
    check_bounds(settings, variable, base);
    if (!(variable.lower < variable.upper))
      throw settings.error(path + ".upper", "the bounds leave no room", "lower must be less than upper",
                           "swap them, or leave out what is not to move");
    if (variable.start < variable.lower || variable.start > variable.upper)
      throw settings.error(
          path + ".start",
          fmt::format("{} lies outside [{}, {}]", variable.start, variable.lower, variable.upper),
          "a search starts within its bounds", "widen the bounds or move the start");
    list.push_back(variable);
  }
  return list;
}

TradeoffSpec tradeoff(const Settings& settings) {
  return {*settings.number("tradeoff.seconds"), static_cast<int>(*settings.integer("tradeoff.seeds")),
          static_cast<std::uint64_t>(*settings.integer("tradeoff.most_photons")),
          *settings.number("tradeoff.reference_accuracy")};
}

constexpr double usual_density_kg_per_m3 = 2700;  // of aluminium

/// What the mirror is made of is at least as thick as the solid that is exported.
double sheet_mm(const Settings& settings, double unit_mm) {
  constexpr double usual_mm = 1;
  for (const char* key : {"reflector.sheet", "reflector.wall"})
    if (const auto thickness = settings.number(key)) return *thickness * unit_mm;
  return usual_mm;
}

TailoredSpec tailored(const Settings& settings, double unit_mm) {
  TailoredSpec spec{};
  const std::string map = *settings.text("tailored.map");
  if (map != "auto") spec.map = map == "crossing" ? RayMap::crossing : RayMap::diverging;
  if (const auto vertex = settings.number("tailored.vertex")) spec.vertex_mm = *vertex * unit_mm;
  spec.rim_angle_rad = *settings.number("tailored.rim_angle") * pi / 180;
  spec.degree = static_cast<int>(*settings.integer("tailored.degree"));
  spec.points = static_cast<std::size_t>(*settings.integer("tailored.points"));
  return spec;
}

Scene build_scene(Settings settings, std::vector<std::string> notes) {
  const LengthUnit unit = scene_unit(settings);
  const double unit_mm = millimetres_per(unit);
  const SourceSpec source = source_spec(settings, unit_mm);
  if (make_source(source)->is_sampled() &&
      *settings.integer("model.replicates") > static_cast<std::int64_t>(sim::parts_of_a_bundle))
    throw settings.error("model.replicates", "is more than a ray file's independent parts",
                         fmt::format("its rays are taken in {} parts, and replicates that share rays would "
                                     "understate the noise",
                                     sim::parts_of_a_bundle),
                         "8, with more photons");
  Profile base = profile(settings, "reflector", unit_mm);
  sim::NearField field = near_field(settings, unit_mm);
  TargetSpec desired = target(settings, unit_mm, field);
  if (desired.kind == TargetKind::paraboloid) check_paraboloid(settings, source, field);
  const sim::Material mirror = mirror_material(settings);
  const Candidate written{base, source, mirror};
  std::vector<optim::Variable> decision = variables(settings, written, unit);
  SearchSpec sought = search(settings, unit_mm);
  if (settings.text("start") != "tailored")  // that is for listed variables, and comes first
    set_free(settings, sought, base, decision, unit);
  const std::optional<double> opened_mm = opening_mm(settings, unit_mm, base);
  std::optional<LandscapeSpec> drawn = landscape_settings(settings, written, decision);
  const Constraints bounds = read_constraints(settings, unit_mm, source.position_mm, field);
  Scene scene{.settings = {},
              .title = *settings.text("title"),
              .unit = unit,
              .seed = static_cast<std::uint64_t>(*settings.integer("seed")),
              .threads = static_cast<int>(*settings.integer("threads")),
              .accuracy_rel = settings.number("accuracy"),
              .source = source,
              .profile = std::move(base),
              .opening_mm = opened_mm,
              .profile_notes = std::move(notes),
              .mirror = mirror,
              .sheet_mm = sheet_mm(settings, unit_mm),
              .density_kg_per_m3 = settings.number("reflector.density").value_or(usual_density_kg_per_m3),
              .near_field = std::move(field),
              .samples = static_cast<std::size_t>(*settings.integer("near_field.samples")),
              .surroundings = read_surroundings(settings, unit_mm),
              .fields = read_fields(settings),
              .grid = settings.text("near_field.grid") == "en12464" ? SampleGrid::en12464 : SampleGrid::area,
              .target = std::move(desired),
              .tailored = tailored(settings, unit_mm),
              .model = model(settings, unit_mm),
              .search = std::move(sought),
              .constraints = bounds,
              .variables = std::move(decision),
              .landscape = std::move(drawn),
              .tradeoff = tradeoff(settings),
              .sensitivity = {*settings.number("sensitivity.allowed"),
                              static_cast<int>(*settings.integer("sensitivity.modes"))},
              .intensity = {*settings.number("intensity.gamma_step"), *settings.number("intensity.c_step"),
                            *settings.text("intensity.luminaire"), *settings.text("intensity.manufacturer"),
                            *settings.text("intensity.lamp"), *settings.text("intensity.issue_date"),
                            *settings.number("intensity.input_power")},
              .rays = {settings.text("rays.format") == "zemax",
                       static_cast<std::uint64_t>(*settings.integer("rays.count")),
                       settings.text("rays.of") == "luminaire"},
              .export_options = export_options(settings, unit_mm)};
  scene.settings = std::move(settings);
  if (scene.settings.has("reflector.flange") && scene.settings.text("start") != "tailored")
    if (const auto start = family_of(scene).at(starts(scene.variables)))
      check_flange(scene.settings, scene.export_options, start->profile);
  return scene;
}

}  // namespace

std::string_view name(Engine engine) {
  return engine == Engine::occt ? "occt" : engine == Engine::mesh ? "mesh" : "meridian";
}

std::string_view name(Metric metric) {
  constexpr std::string_view names[] = {
      "rmse",       "relative-rmse",  "enclosed-flux", "uniformity",
      "efficiency", "intensity-rmse", "diversity",     "relative-intensity-rmse"};
  return names[static_cast<std::size_t>(metric)];
}

Scene read_scene(const std::filesystem::path& file, const std::vector<Override>& overrides) {
  Settings settings = Settings::read(file, scene_keys());
  for (const Override& change : overrides) settings.set(change);
  return make_scene(std::move(settings));
}

Scene written_scene(Settings settings) {
  std::vector<std::string> notes = complete(settings);
  return build_scene(std::move(settings), std::move(notes));
}

Scene make_scene(Settings settings) {
  const bool from_nothing = !settings.has("reflector.points") && !settings.has("reflector.profile");
  Scene scene = written_scene(std::move(settings));
  if (scene.settings.text("start") != "tailored") return scene;
  std::vector<std::string> notes = scene.profile_notes;
  if (scene.surroundings) {
    notes.push_back("tailored as if mirror and near field stood alone; figures are those of the whole scene");
    scene.surroundings = nullptr;
    scene.fields.clear();
  }
  if (scene.near_field.shape() == sim::NearField::Shape::rectangle) {
    // A target along the radius is made on the disc that holds the rectangle's sides.
    const sim::NearField& field = scene.near_field;
    scene.near_field = sim::NearField::disc(field.center_mm(), field.normal(),
                                            std::max(field.half_width_mm(), field.half_height_mm()));
    scene.grid = SampleGrid::area;
  }
  Settings tailored = tailored_settings(scene, from_nothing, notes);
  return build_scene(std::move(tailored), std::move(notes));
}

}  // namespace catoptric::design
