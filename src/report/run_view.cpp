#include "report/run_view.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "sim/facet_field.h"

namespace catoptric::report {
namespace {

constexpr double most_sizes_away = 4;  ///< a mirror beside a field farther away would be a speck
constexpr std::size_t most_corners = 40;
constexpr int points_of_a_span = 24, points_of_a_round = 72;

using Box = Eigen::AlignedBox3d;

Polyline generatrix_points(const Profile& profile) {
  Polyline points;
  for (const RationalSpan& span : profile.spans())
    for (int i = points.empty() ? 0 : 1; i <= points_of_a_span; ++i) {
      const MeridianPoint p = evaluate(span, static_cast<double>(i) / points_of_a_span);
      points.emplace_back(p.r_mm, 0, p.z_mm);
    }
  return points;
}

/// A closed line on a field, through places of its surface coordinates in [-1, 1].
Polyline outline(const sim::NearField& field, const std::vector<Vector2>& places) {
  Polyline points;
  for (const Vector2& place : places)
    points.push_back(field.to_space({place.x() * field.half_width_mm(), place.y() * field.half_height_mm()}));
  points.push_back(points.front());
  return points;
}

std::vector<Vector2> unit_circle() {
  std::vector<Vector2> places;
  for (int i = 0; i < points_of_a_round; ++i) {
    const double angle = 2 * pi * i / points_of_a_round;
    places.emplace_back(std::cos(angle), std::sin(angle));
  }
  return places;
}

/// The end of an unrolled cylinder at one of its sides.
std::vector<Vector2> rim_of_cylinder(double side) {
  std::vector<Vector2> places;
  for (int i = 0; i < points_of_a_round; ++i) places.emplace_back(2.0 * i / points_of_a_round - 1, side);
  return places;
}

ViewedField viewed(const sim::NearField& field) {
  using enum sim::NearField::Shape;
  switch (field.shape()) {
    case disc:
      return {{outline(field, unit_circle())}, field.center_mm(), true};
    case rectangle:
      return {{outline(field, {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})}, field.center_mm(), true};
    case facets:
      return {field.facets()->outlines(), field.center_mm(), false};
    case cylinder:
      break;
  }
  return {
      {outline(field, rim_of_cylinder(-1)), outline(field, rim_of_cylinder(1))}, field.center_mm(), false};
}

std::vector<ViewedSource> viewed(const design::SourceSpec& source, const Vector3& from_mm) {
  std::vector<ViewedSource> list;
  for (const design::SourceSpec& part : source.parts)
    for (const ViewedSource& each : viewed(part, from_mm + source.position_mm)) list.push_back(each);
  if (!list.empty()) return list;
  using Kind = design::SourceKind;
  const char* kind = source.kind == Kind::disc        ? "disc"
                     : source.kind == Kind::rectangle ? "rectangle"
                     : source.kind == Kind::cylinder  ? "cylinder"
                                                      : "ball";
  const Vector3 axis = source.axis.normalized();
  const bool has_along = source.kind == Kind::rectangle && source.along.cross(axis).norm() > 0;
  return {{kind, from_mm + source.position_mm, axis, has_along ? source.along : axis.unitOrthogonal(),
           source.radius_mm, source.length_mm, source.width_mm, source.height_mm}};
}

/// A photon's way, on beyond its last corner to where it lands, or to the end of what is seen.
Polyline way_of(const sim::LightPath& path, const Vector3& center_mm, double radius_mm) {
  Polyline way = path.corners_mm;
  if (way.size() > most_corners) {  // light caught in a cavity
    way.resize(most_corners);
    return way;
  }
  if (path.leaves_towards) {
    const Vector3 last = way.back(), towards = *path.leaves_towards;
    const bool lands_now = path.landed_mm && (*path.landed_mm - last).dot(towards) > 0 &&
                           (*path.landed_mm - last).cross(towards).norm() < 1e-6 * radius_mm;
    way.push_back(lands_now ? *path.landed_mm
                            : Vector3(last + ((last - center_mm).norm() + 2 * radius_mm) * towards));
  }
  return within(way, center_mm, 1.1 * radius_mm);
}

/// How far from the mirror's middle a place is, in what is drawn beside it at most.
double farness(const Vector3& point_mm, const Profile& profile) {
  const Vector3 middle_mm(0, 0, 0.5 * (profile.z_min_mm() + profile.z_max_mm()));
  return (point_mm - middle_mm).norm() / ((1 + most_sizes_away) * profile.diagonal_mm());
}

bool is_near(const sim::NearField& field, const Profile& profile) {
  const double size_mm = std::max(field.half_width_mm(), field.half_height_mm());
  return farness(field.center_mm(), profile) + size_mm / ((1 + most_sizes_away) * profile.diagonal_mm()) < 1;
}

/// Adds the lines of the objects that are near as a whole.
/// @out  how many are not
std::size_t add_objects(View3d& view, Box& box, const sim::Surroundings& surroundings,
                        const Profile& profile) {
  std::size_t far = 0;
  for (const sim::Object& object : surroundings.objects()) {
    std::vector<Polyline> lines;
    for (const auto& face : object.faces)
      for (Polyline& line : face->outlines()) lines.push_back(std::move(line));
    const bool near = std::ranges::all_of(lines, [&](const Polyline& line) {
      return std::ranges::all_of(line, [&](const Vector3& point) { return farness(point, profile) < 1; });
    });
    if (!near) {
      ++far;
      continue;
    }
    for (Polyline& line : lines) {
      for (const Vector3& point : line) box.extend(point);
      view.objects.push_back(std::move(line));
    }
  }
  return far;
}

void add(Box& box, const ViewedField& field) {
  for (const Polyline& outline : field.outlines)
    for (const Vector3& point : outline) box.extend(point);
}

void scale(Polyline& points, double factor) {
  for (Vector3& point : points) point *= factor;
}

/// All lengths from mm to the scene's unit.
void to_scene_unit(View3d& view, double factor) {
  for (Vector2& point : view.generatrix) point *= factor;
  for (Polyline& ray : view.rays) scale(ray, factor);
  for (Polyline& line : view.objects) scale(line, factor);
  for (ViewedField& field : view.fields) {
    for (Polyline& outline : field.outlines) scale(outline, factor);
    field.center *= factor;
  }
  for (ViewedSource& source : view.sources) {
    source.position *= factor;
    for (double* length : {&source.radius, &source.length, &source.width, &source.height}) *length *= factor;
  }
  view.center *= factor;
  view.radius *= factor;
}

std::string caption(const design::Scene& scene, const View3d& view, double far_mm, std::size_t far_objects) {
  std::string text =
      "The mirror in space: drag to turn, scroll after that to come nearer, double-click to stand back. ";
  text += view.rays.empty()
              ? "No ray met the mirror."
              : fmt::format(
                    "{} rays of the verdict's kind, dashed from the source to the first surface "
                    "they meet, solid from there on.",
                    view.rays.size());
  text += view.fields.empty() ? "" : " Grey: where irradiance is asked for.";
  if (far_mm > 0)
    text +=
        fmt::format(" The near field, {:.4g} {} from the source, is too far to be drawn beside the mirror.",
                    scene.to_scene_unit(far_mm), symbol(scene.unit));
  if (!view.objects.empty()) text += " Green: objects about the mirror.";
  if (far_objects > 0)
    text +=
        fmt::format(" {} {} too far or too large to be drawn beside it, but the rays meet {}.", far_objects,
                    far_objects == 1 ? "object is" : "objects are", far_objects == 1 ? "it" : "them");
  return text;
}

}  // namespace

View3d view_of(const design::Scene& scene, const Profile& profile, const design::SourceSpec& source,
               const std::vector<sim::LightPath>& paths) {
  View3d view;
  Box box;
  for (const Vector3& point : generatrix_points(profile)) {
    view.generatrix.emplace_back(point.x(), point.z());
    box.extend(Vector3(point.x(), point.x(), point.z()));
    box.extend(Vector3(-point.x(), -point.x(), point.z()));
  }
  view.sources = viewed(source, Vector3::Zero());
  for (const ViewedSource& each : view.sources) box.extend(each.position);
  std::vector<const sim::NearField*> fields{&scene.near_field};
  if (scene.surroundings)
    for (const sim::MoreField& more : scene.surroundings->fields()) fields.push_back(&more.field);
  for (const sim::NearField* field : fields)
    if (is_near(*field, profile)) {
      view.fields.push_back(viewed(*field));
      add(box, view.fields.back());
    }
  const std::size_t far_objects =
      scene.surroundings ? add_objects(view, box, *scene.surroundings, profile) : 0;
  const bool far = !is_near(scene.near_field, profile);
  view.center = box.center();
  view.radius = (view.fields.empty() ? 0.75 : 0.5) * box.diagonal().norm();  // room for rays that go far
  for (const sim::LightPath& path : paths) {
    Polyline way = way_of(path, view.center, view.radius);
    if (way.size() >= 2) view.rays.push_back(std::move(way));
  }
  // The eye stands where the mirror is open: on the side its rim lies of its apex.
  view.from_above = profile.at(profile.last_parameter()).z_mm > profile.at(profile.first_parameter()).z_mm;
  view.caption =
      caption(scene, view, far ? (scene.near_field.center_mm() - source.position_mm).norm() : 0, far_objects);
  to_scene_unit(view, scene.to_scene_unit(1));
  return view;
}

}  // namespace catoptric::report
