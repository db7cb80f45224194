#include "design/surroundings_settings.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <mutex>
#include <utility>

#include "base/units.h"
#include "cad/surface_import.h"
#include "design/source_settings.h"
#include "sim/facet_field.h"
#include "sim/object_shapes.h"

namespace catoptric::design {
namespace {

constexpr const char* objects = "objects";
constexpr const char* fields = "fields";

/// Keys that each kind of thing needs, and those that it may have beside what all have.
struct KindKeys {
  std::vector<std::string> needed, allowed;
};

const std::map<std::string, KindKeys>& object_kinds() {
  static const std::map<std::string, KindKeys> kinds{
      {"disc", {{"radius"}, {"inner_radius", "normal"}}},
      {"rectangle", {{"width", "height"}, {"normal", "along"}}},
      {"cylinder", {{"radius", "length"}, {"normal"}}},
      {"sphere", {{"radius"}, {"half_angle", "normal"}}},
      {"pane", {{"thickness"}, {"radius", "width", "height", "normal", "along"}}},
      {"dome", {{"radius", "thickness"}, {"half_angle", "normal"}}},
      {"file", {{"file"}, {"chord_error"}}}};
  return kinds;
}

const std::map<std::string, KindKeys>& field_shapes() {
  static const std::map<std::string, KindKeys> shapes{
      {"disc", {{"radius"}, {"normal"}}},
      {"rectangle", {{"width", "height"}, {"normal", "along"}}},
      {"cylinder", {{"radius", "length"}, {"normal", "lit"}}},
      {"file", {{"file"}, {"chord_error", "lit"}}}};
  return shapes;
}

const std::vector<std::string> sizes{"radius", "inner_radius", "width",      "height",
                                     "length", "thickness",    "half_angle", "normal",
                                     "along",  "lit",          "file",       "chord_error"};
const std::vector<std::string> of_sheets{"reflectance", "diffuse", "transmittance", "roughness"},
    of_fields{"reflectance", "transmittance"}, of_glass{"index", "absorption"};

/// The keys of one thing: `objects.NAME.radius`.
class OneThing {
 public:
  OneThing(const Settings& settings, const char* table, const std::string& name)
      : settings_(settings), prefix_(fmt::format("{}.{}", table, name)), name_(name) {}

  std::string path(const std::string& key) const { return prefix_ + "." + key; }
  const std::string& name() const { return name_; }
  bool has(const std::string& key) const { return settings_.has(path(key)); }
  std::string text(const std::string& key) const { return settings_.text(path(key)).value_or(""); }
  double number(const std::string& key) const { return *settings_.number(path(key)); }
  bool is_glass() const { return text("kind") == "pane" || text("kind") == "dome"; }

  Vector3 vector(const std::string& key) const {
    const Numbers v = *settings_.numbers(path(key));
    return {v[0], v[1], v[2]};
  }
  Vector3 direction(const std::string& key) const {
    const Vector3 found = vector(key);
    require_direction(settings_, path(key).c_str(), found);
    return found;
  }
  Vector3 across(const Vector3& normal) const {
    const Vector3 along = direction("along");
    constexpr double least_sine = 1e-6;  // no direction in the plane is left below that
    if (!(along.normalized().cross(normal.normalized()).norm() > least_sine))
      throw settings_.error(path("along"), "is parallel to the normal", "it must lie across it", "[1, 0, 0]");
    return along;
  }

  [[noreturn]] void refuse(const std::string& key, const std::string& what, const std::string& why,
                           const std::string& hint) const {
    throw settings_.error(path(key), what, why, hint);
  }

  void require(const std::string& key, const std::string& kind) const {
    if (!has(key)) refuse(key, "is missing", fmt::format("a {} needs it", kind), path(key) + " = 10");
  }

  void check_sizes(const KindKeys& keys, const std::string& kind) const {
    for (const std::string& key : keys.needed) require(key, kind);
    for (const std::string& key : sizes) {
      const auto in = [&](const std::vector<std::string>& list) { return std::ranges::count(list, key) > 0; };
      if (has(key) && !in(keys.needed) && !in(keys.allowed))
        refuse(key, fmt::format("does not belong to a {}", kind), "it would have no effect", "remove it");
    }
  }

 private:
  const Settings& settings_;
  std::string prefix_, name_;
};

/// A direction across the normal, whichever will do.
std::string usual_along(const Settings& settings, const std::string& normal_path) {
  const auto n = *settings.numbers(normal_path);
  return std::abs(n[0]) <= 0.9 * std::hypot(n[0], n[1], n[2]) ? "[1.0, 0.0, 0.0]" : "[0.0, 1.0, 0.0]";
}

void refuse_all(const OneThing& thing, const std::vector<std::string>& keys, const std::string& why) {
  for (const std::string& key : keys)
    if (thing.has(key)) thing.refuse(key, "has no effect", why, "remove it");
}

void complete_object(Settings& settings, const std::string& name) {
  const OneThing object(settings, objects, name);
  const auto fill = [&](const char* key, const std::string& value) {
    settings.fill(object.path(key), value);
  };
  if (!object.has("kind"))
    object.refuse("kind", "is missing", "a thing has a shape", object.path("kind") + " = \"disc\"");
  const std::string kind = object.text("kind");
  object.check_sizes(object_kinds().at(kind), kind);
  fill("center", "[0.0, 0.0, 0.0]");
  const bool whole_sphere = (kind == "sphere" || kind == "dome") && !object.has("half_angle");
  if (whole_sphere && object.has("normal"))
    object.refuse("normal", "has no effect", "a whole sphere looks alike from all sides",
                  "remove it, or give a half_angle");
  if (kind == "file") {
    settings.make_absolute(object.path("file"));
    fill("chord_error", "0.001");
  } else if (!whole_sphere) {
    fill("normal", "[0.0, 0.0, 1.0]");
  }
  fill("belongs", "\"luminaire\"");
  const bool flat_pane = kind == "pane" && object.has("width") != object.has("radius");
  if (kind == "pane" && (!flat_pane || object.has("width") != object.has("height")))
    object.refuse("radius", "does not settle the pane's shape", "a pane is round or a rectangle",
                  "a radius, or width and height");
  if (kind == "rectangle" || object.has("width"))
    fill("along", usual_along(settings, object.path("normal")));
  else if (kind == "pane" && object.has("along"))
    object.refuse("along", "has no effect", "a round pane has no such direction", "remove it");
  if (object.is_glass()) {
    refuse_all(object, of_sheets, "Fresnel's law and absorption say what glass does");
    if (!object.has("index"))
      object.refuse("index", "is missing", "glass needs its refractive index",
                    object.path("index") + " = 1.49 for acrylic, 1.52 for window glass");
    fill("absorption", "0.0");
    return;
  }
  refuse_all(object, of_glass, "only a pane or a dome is of glass");
  if (kind == "disc") fill("inner_radius", "0.0");
  for (const char* key : {"reflectance", "diffuse", "transmittance"}) fill(key, "0.0");
}

void check_lit(const OneThing& field, const std::string& shape) {
  if (!field.has("lit")) return;
  const std::string lit = field.text("lit");
  const bool of_file = lit == "front" || lit == "back";
  if (of_file != (shape == "file"))
    field.refuse("lit", "is no side of this shape",
                 "a cylinder is lit inside or outside, the faces of a file on their front or back",
                 shape == "file" ? "\"front\"" : "\"inside\"");
}

void complete_field(Settings& settings, const std::string& name) {
  const OneThing field(settings, fields, name);
  const auto fill = [&](const char* key, const std::string& value) { settings.fill(field.path(key), value); };
  fill("shape", "\"rectangle\"");
  const std::string shape = field.text("shape");
  field.check_sizes(field_shapes().at(shape), shape);
  fill("center", "[0.0, 0.0, 0.0]");
  if (shape == "file") {
    settings.make_absolute(field.path("file"));
    fill("chord_error", "0.001");
    fill("lit", "\"front\"");
  } else {
    fill("normal", "[0.0, 0.0, 1.0]");
  }
  check_lit(field, shape);
  if (shape == "cylinder") fill("lit", "\"inside\"");
  if (shape == "rectangle") fill("along", usual_along(settings, field.path("normal")));
  fill("samples", "256");
  fill("real", "false");
  if (!field.has("irradiance") && field.has("weight"))
    field.refuse("weight", "stands alone", "no irradiance is wanted there",
                 field.path("irradiance") + " = 1.0");
  if (field.has("irradiance")) fill("weight", "1.0");
  if (*settings.boolean(field.path("real")))
    for (const std::string& key : of_fields) fill(key.c_str(), "0.0");
  else
    for (const std::string& key : of_fields)
      if (field.has(key))
        field.refuse(key, "an invisible field has no material", "it only registers light",
                     field.path("real") + " = true");
  if (settings.has("model.neighbours")) {
    refuse_all(field, {"kernel_radius"}, "model.neighbours sets the bandwidth");
    return;
  }
  if (shape == "file") {
    if (!field.has("kernel_radius"))
      field.refuse("kernel_radius", "is missing",
                   "how large a file's faces are is not known before it is read",
                   "a tenth of their size is usual");
    return;
  }
  const double half = shape == "disc"       ? field.number("radius")
                      : shape == "cylinder" ? std::min(field.number("radius"), 0.5 * field.number("length"))
                                            : 0.5 * std::min(field.number("width"), field.number("height"));
  fill("kernel_radius", fmt::format("{}", 0.1 * half));
}

/// Shares checked to add up to no more than all light.
sim::Material checked_sheet(const Settings& settings, const OneThing& thing, const sim::Material& material) {
  if (material.reflectance + material.diffuse + material.transmittance > 1)
    throw settings.error(thing.path("transmittance"), "more light leaves than arrives",
                         "reflectance, diffuse and transmittance add up to more than 1", "lower one of them");
  return material;
}

sim::Material object_sheet(const Settings& settings, const OneThing& thing) {
  sim::Material material;
  material.reflectance = thing.number("reflectance");
  material.diffuse = thing.number("diffuse");
  material.transmittance = thing.number("transmittance");
  if (thing.has("roughness")) material.roughness = thing.number("roughness");
  if (material.roughness > 0 && !(material.reflectance > 0))
    thing.refuse("roughness", "has no effect", "nothing is reflected like from a mirror",
                 thing.path("reflectance") + " = 0.8");
  return checked_sheet(settings, thing, material);
}

sim::Material field_sheet(const Settings& settings, const OneThing& thing) {
  return checked_sheet(settings, thing,
                       sim::Material::matt(thing.number("reflectance"), thing.number("transmittance")));
}

/// A shape with its origin elsewhere.
class Moved final : public SurfaceShape {
 public:
  Moved(sim::ShapePointer shape, const Vector3& origin_mm)
      : shape_(std::move(shape)), origin_mm_(origin_mm) {}
  std::optional<Meeting> meet(const Ray& ray, bool starts_here, double reach_mm) const override {
    return shape_->meet({ray.origin_mm - origin_mm_, ray.direction}, starts_here, reach_mm);
  }
  std::vector<std::vector<Vector3>> outlines() const override {
    auto lines = shape_->outlines();
    for (auto& line : lines)
      for (Vector3& point : line) point += origin_mm_;
    return lines;
  }

 private:
  sim::ShapePointer shape_;
  Vector3 origin_mm_;
};

sim::ShapePointer moved(sim::ShapePointer shape, const Vector3& origin_mm) {
  if (origin_mm.isZero(0)) return shape;
  return std::make_shared<Moved>(std::move(shape), origin_mm);
}

using Imported = std::shared_ptr<const cad::ImportedSurface>;

/// Faces of a file. It is read once as long as some scene holds them: runs of a study and steps of a search
/// make many scenes of one file.
Imported imported(const OneThing& thing) {
  static std::mutex mutex;
  static std::map<std::string, std::weak_ptr<const cad::ImportedSurface>> known;
  const std::filesystem::path file = thing.text("file");
  std::error_code none;
  const auto changed = std::filesystem::last_write_time(file, none).time_since_epoch().count();
  const std::string key = fmt::format("{}|{}|{}", file.string(), changed, thing.number("chord_error"));
  const std::lock_guard lock(mutex);
  if (Imported surface = known[key].lock()) return surface;
  const auto surface =
      std::make_shared<const cad::ImportedSurface>(cad::import_surface(file, {thing.number("chord_error")}));
  known[key] = surface;
  return surface;
}

/// Its shape, which holds all of it.
sim::ShapePointer shape_of(const Imported& surface) { return {surface, surface->shape.get()}; }

sim::NearField facets_field(const OneThing& field, const Vector3& center_mm,
                            const std::optional<sim::Material>& material) {
  const Imported surface = imported(field);
  std::shared_ptr<const Facets> facets = surface->facets;
  if (!center_mm.isZero(0)) {
    auto moved_facets = std::make_shared<Facets>(*facets);
    for (Vector3& point_mm : moved_facets->points_mm) point_mm += center_mm;
    facets = std::move(moved_facets);
  }
  return sim::NearField::facets(
      std::make_shared<const sim::FacetField>(moved(shape_of(surface), center_mm), std::move(facets),
                                              field.text("lit") == "front"),
      material);
}

/// The faces of a thing, by its kind.
std::vector<sim::ShapePointer> faces(const OneThing& object, double unit_mm) {
  const auto length = [&](const char* key) { return object.number(key) * unit_mm; };
  const std::string kind = object.text("kind");
  const Vector3 center_mm = unit_mm * object.vector("center");
  if (kind == "file") return {moved(shape_of(imported(object)), center_mm)};
  const Vector3 normal = object.has("normal") ? object.direction("normal") : Vector3::UnitZ();
  const double half_angle = object.has("half_angle") ? object.number("half_angle") * pi / 180 : pi;
  if (kind == "disc") {
    if (!(object.number("inner_radius") < object.number("radius")))
      object.refuse("inner_radius", "is not less than the radius", "a ring has a hole within it", "lower it");
    return {sim::make_disc(center_mm, normal, length("radius"), length("inner_radius"))};
  }
  if (kind == "rectangle")
    return {sim::make_rectangle(center_mm, normal, object.across(normal), length("width"), length("height"))};
  if (kind == "cylinder") return {sim::make_tube(center_mm, normal, length("radius"), length("length"))};
  if (kind == "sphere") return {sim::make_cap(center_mm, normal, length("radius"), half_angle)};
  const double thickness_mm = length("thickness");
  if (kind == "dome") {
    if (!(thickness_mm < length("radius")))
      object.refuse("thickness", "is not less than the radius", "a dome is hollow", "lower it");
    return {sim::make_cap(center_mm, normal, length("radius"), half_angle),
            sim::make_cap(center_mm, normal, length("radius") - thickness_mm, half_angle,
                          sim::SphereFront::inside)};
  }
  // A pane lies about its centre.
  const Vector3 half_mm = 0.5 * thickness_mm * normal.normalized();
  if (object.has("radius"))
    return {sim::make_disc(center_mm + half_mm, normal, length("radius")),
            sim::make_disc(center_mm - half_mm, -normal, length("radius"))};
  const Vector3 along = object.across(normal);
  return {sim::make_rectangle(center_mm + half_mm, normal, along, length("width"), length("height")),
          sim::make_rectangle(center_mm - half_mm, -normal, along, length("width"), length("height"))};
}

sim::Object object_of(const Settings& settings, const OneThing& thing, double unit_mm) {
  sim::Object object{thing.name(), faces(thing, unit_mm), {0, 0}, {}};
  object.of_luminaire = thing.text("belongs") == "luminaire";
  if (thing.is_glass())
    object.glass = sim::Glass{thing.number("index"), thing.number("absorption") / unit_mm};
  else
    object.material = object_sheet(settings, thing);
  return object;
}

sim::MoreField field_of(const Settings& settings, const OneThing& thing, double unit_mm) {
  const auto length = [&](const char* key) { return thing.number(key) * unit_mm; };
  const std::string shape = thing.text("shape");
  const Vector3 center_mm = unit_mm * thing.vector("center");
  std::optional<sim::Material> material;
  if (*settings.boolean(thing.path("real"))) material = field_sheet(settings, thing);
  double scale = 1;
  if (const auto radius = settings.number("model.kernel_radius")) {
    scale = thing.number("kernel_radius") / *radius;
    if (shape == "cylinder" && !(thing.number("kernel_radius") <= pi * thing.number("radius")))
      thing.refuse("kernel_radius", "reaches more than once round the cylinder",
                   "it is at most half the girth", "lower it");
  }
  if (shape == "file") return {thing.name(), facets_field(thing, center_mm, material), scale};
  const Vector3 normal = thing.direction("normal");
  if (shape == "disc")
    return {thing.name(), sim::NearField::disc(center_mm, normal, length("radius"), material), scale};
  if (shape == "cylinder")
    return {thing.name(),
            sim::NearField::cylinder(center_mm, normal, length("radius"), length("length"),
                                     thing.text("lit") == "inside", material),
            scale};
  return {thing.name(),
          sim::NearField::rectangle(center_mm, normal, thing.across(normal), length("width"),
                                    length("height"), material),
          scale};
}

}  // namespace

void complete_surroundings(Settings& settings) {
  for (const std::string& name : settings.names_under(objects)) complete_object(settings, name);
  const std::vector<std::string> names = settings.names_under(fields);
  for (const std::string& name : names) complete_field(settings, name);
  constexpr std::size_t most_fields = 250;
  if (names.size() > most_fields)
    throw settings.error("fields." + names.front() + ".shape", fmt::format("{} fields", names.size()),
                         fmt::format("at most {} are taken", most_fields), "fewer, or larger ones");
  if (!names.empty() && settings.has("accuracy"))
    throw settings.error("accuracy", "stands beside further fields",
                         "an accuracy is proven for the near field alone",
                         "remove it and set model.photons, or remove fields." + names.front());
}

std::shared_ptr<const sim::Surroundings> read_surroundings(const Settings& settings, double unit_mm) {
  std::vector<sim::Object> things;
  for (const std::string& name : settings.names_under(objects))
    things.push_back(object_of(settings, OneThing(settings, objects, name), unit_mm));
  std::vector<sim::MoreField> more;
  for (const std::string& name : settings.names_under(fields))
    more.push_back(field_of(settings, OneThing(settings, fields, name), unit_mm));
  if (things.empty() && more.empty()) return nullptr;
  return std::make_shared<const sim::Surroundings>(std::move(things), std::move(more));
}

std::vector<FieldSpec> read_fields(const Settings& settings) {
  std::vector<FieldSpec> list;
  for (const std::string& name : settings.names_under(fields)) {
    const OneThing field(settings, fields, name);
    FieldSpec spec{name, static_cast<std::size_t>(*settings.integer(field.path("samples"))), {}, 0};
    if (const auto wanted = settings.number(field.path("irradiance"))) {
      spec.irradiance_w_per_mm2 = from_w_per_m2(*wanted);
      spec.weight = field.number("weight");
    }
    list.push_back(spec);
  }
  return list;
}

}  // namespace catoptric::design
