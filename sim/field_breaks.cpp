#include "sim/field_breaks.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "base/tolerance.h"
#include "base/units.h"
#include "sim/opening.h"
#include "sim/scatter.h"
#include "sim/smooth_stretches.h"

namespace catoptric::sim {
namespace {

constexpr std::size_t rows_of_rays = 17;     ///< of rays along all of the generatrix
constexpr std::size_t columns_of_rays = 32;  ///< of rays round the axis
constexpr std::size_t fewest_edge_columns = 32, most_edge_columns = 256;

/// A ray from the source by way of a point of the mirror.
struct Node {
  Vector3 way;  ///< from the source, unit
  Ray leaving;
  double reflected = 1;  ///< share of the light
  bool lands = false;
  Vector2 plane_mm = Vector2::Zero();  ///< where, in plane coordinates of the near field
};

/// Unit vectors away from the axis, evenly round it.
std::vector<Vector3> ways_out(std::size_t count) {
  std::vector<Vector3> ways;
  ways.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double azimuth = 2 * pi * static_cast<double>(i) / static_cast<double>(count);
    ways.emplace_back(std::cos(azimuth), std::sin(azimuth), 0);
  }
  return ways;
}

/// @in out: away from the axis, unit
Node node_by(const Scene& scene, const MeridianPoint& at, const Vector3& out) {
  const Vector3 point = at.r_mm * out + Vector3(0, 0, at.z_mm);
  const Vector3 normal = (at.dz * out - Vector3(0, 0, at.dr)).normalized();
  const NearField& field = scene.near_field;
  Node node;
  node.way = (point - scene.source.position_mm()).normalized();
  node.leaving = {point, reflect(node.way, normal)};
  if (scene.mirror.by_angle) node.reflected = scene.mirror.by_angle->relative(std::abs(node.way.dot(normal)));
  const double climb = node.leaving.direction.dot(field.normal());
  if (climb == 0) return node;
  const double distance = (field.center_mm() - point).dot(field.normal()) / climb;
  node.lands = distance > 0 && std::isfinite(distance);
  if (node.lands) node.plane_mm = field.to_plane(point + distance * node.leaving.direction);
  return node;
}

double cross(const Vector2& a, const Vector2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// How far a point lies outside the patch; 0 inside.
double outside_mm(const NearField& field, const Vector2& plane_mm) {
  if (field.shape() == NearField::Shape::disc) return std::max(0.0, plane_mm.norm() - field.half_width_mm());
  return std::hypot(std::max(0.0, std::abs(plane_mm.x()) - field.half_width_mm()),
                    std::max(0.0, std::abs(plane_mm.y()) - field.half_height_mm()));
}

/// How far from the patch the image of a circle of the mirror stays, by so many of its points.
double clear_of_circle(const Scene& scene, const MeridianPoint& at, std::size_t points) {
  const std::vector<Vector3> ways = ways_out(points);
  double clear = HUGE_VAL;
  Node last = node_by(scene, at, ways.back());
  for (const Vector3& way : ways) {
    const Node next = node_by(scene, at, way);
    // Where part of it goes away from the plane the rest comes from far away, nobody knows how.
    if (last.lands != next.lands) return 0;
    if (next.lands) {
      // An arc half as long again as its chord stays that near to one of its ends.
      constexpr double swing = 0.75;
      clear = std::min(clear, std::min(outside_mm(scene.near_field, last.plane_mm),
                                       outside_mm(scene.near_field, next.plane_mm)) -
                                  swing * (last.plane_mm - next.plane_mm).norm());
    }
    last = next;
  }
  return std::max(0.0, clear);
}

/// The same by as many points as it takes to know that it is enough.
double clear_of_circle(const Scene& scene, const MeridianPoint& at, double enough_mm) {
  double clear = 0;
  for (std::size_t points = fewest_edge_columns; points <= most_edge_columns && clear < enough_mm;
       points *= 2)
    clear = clear_of_circle(scene, at, points);
  return clear;
}

/// The rays of one smooth stretch, rows along the generatrix and columns round the axis.
class Sheet {
 public:
  Sheet(const Scene& scene, const SmoothStretch& stretch, std::size_t row_count)
      : scene_(scene), rows_(row_count) {
    const Profile& profile = scene.reflector.profile();
    const std::vector<Vector3> ways = ways_out(columns_of_rays);
    nodes_.reserve(rows_ * columns_of_rays);
    const double step = (stretch.last - stretch.first) / static_cast<double>(rows_ - 1);
    for (std::size_t row = 0; row < rows_; ++row) {
      const MeridianPoint at = row == 0 ? stretch.begin
                               : row + 1 == rows_
                                   ? stretch.end
                                   : profile.at(stretch.first + static_cast<double>(row) * step);
      for (const Vector3& way : ways) nodes_.push_back(node_by(scene, at, way));
    }
  }

  /// Without the first and last row: rays to the very vertex and rim cost engines most, and say no more.
  std::span<const Node> inner_nodes() const {
    return std::span(nodes_).subspan(columns_of_rays, (rows_ - 2) * columns_of_rays);
  }

  /// How far from the patch cells stay that turn over, crowd, or partly land nowhere.
  double clear_of_breaks() const {
    std::vector<Cell> cells;
    cells.reserve((rows_ - 1) * columns_of_rays);
    for (std::size_t row = 0; row + 1 < rows_; ++row)
      for (std::size_t column = 0; column < columns_of_rays; ++column) cells.push_back(cell_at(row, column));
    double clear = HUGE_VAL;
    const auto compare = [&](const Cell& a, const Cell& b) {
      if (!agree(a, b)) clear = std::min({clear, a.clear_mm, b.clear_mm});
    };
    for (std::size_t i = 0; i < cells.size(); ++i) {
      compare(cells[i], cells[i % columns_of_rays == columns_of_rays - 1 ? i + 1 - columns_of_rays : i + 1]);
      if (i + columns_of_rays < cells.size()) compare(cells[i], cells[i + columns_of_rays]);
    }
    return clear;
  }

 private:
  struct Cell {
    bool whole = true;                 ///< all of its corners land
    double clear_mm = HUGE_VAL;        ///< of the patch
    double area_mm2 = 0, power_w = 0;  ///< the area's sign is the orientation
  };

  Cell cell_at(std::size_t row, std::size_t column) const {
    const std::size_t next = (column + 1) % columns_of_rays;
    const Node* corners[] = {
        &nodes_[row * columns_of_rays + column], &nodes_[(row + 1) * columns_of_rays + column],
        &nodes_[(row + 1) * columns_of_rays + next], &nodes_[row * columns_of_rays + next]};
    Cell cell;
    double nearest = HUGE_VAL;
    Eigen::AlignedBox2d box;
    for (const Node* corner : corners) {
      cell.whole &= corner->lands;
      if (!corner->lands) continue;
      nearest = std::min(nearest, outside_mm(scene_.near_field, corner->plane_mm));
      box.extend(corner->plane_mm);
    }
    if (nearest < HUGE_VAL) cell.clear_mm = std::max(0.0, nearest - box.diagonal().norm());
    cell.area_mm2 =
        0.5 * cross(corners[2]->plane_mm - corners[0]->plane_mm, corners[3]->plane_mm - corners[1]->plane_mm);
    const Vector3 middle = corners[0]->way + corners[1]->way + corners[2]->way + corners[3]->way;
    cell.power_w = scene_.source.intensity_w_per_sr(middle.normalized()) * 0.5 *
                   (corners[2]->way - corners[0]->way).cross(corners[3]->way - corners[1]->way).norm();
    if (scene_.mirror.by_angle)
      cell.power_w *= 0.25 * (corners[0]->reflected + corners[1]->reflected + corners[2]->reflected +
                              corners[3]->reflected);
    return cell;
  }

  /// Whether two neighbours show one smooth irradiance.
  static bool agree(const Cell& a, const Cell& b) {
    constexpr double most = 2;
    if (a.power_w == 0 && b.power_w == 0) return true;  // a source that leaves them dark
    if (!a.whole || !b.whole) return false;
    const double one = a.power_w * b.area_mm2, other = b.power_w * a.area_mm2;
    return one * other > 0 && std::abs(one) < most * std::abs(other) &&
           std::abs(other) < most * std::abs(one);
  }

  const Scene& scene_;
  std::size_t rows_;
  std::vector<Node> nodes_;
};

/// Whether the source sees all the nodes, and what they reflect goes away from the mirror.
class Meetings {
 public:
  explicit Meetings(const Scene& scene)
      : scene_(scene),
        probe_(scene.reflector.probe()),
        opening_(Opening::of(scene.reflector.profile())),
        lift_mm_(Tolerance::for_scale(scene.reflector.profile().diagonal_mm()).lift_mm) {
    const Vector3 source = scene.source.position_mm();
    stride_ = source.x() == 0 && source.y() == 0 ? columns_of_rays : 1;  // on the axis all columns are alike
  }

  bool hidden(std::span<const Node> nodes) {
    const Vector3 source = scene_.source.position_mm();
    std::vector<Ray> rays;
    std::vector<double> ways_mm;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const double way_mm = (nodes[i].leaving.origin_mm - source).norm();
      if (stopped_by_field({source, nodes[i].way}, way_mm)) return true;
      if (i % stride_ != 0) continue;
      rays.push_back({source, nodes[i].way});
      ways_mm.push_back(way_mm);
    }
    const auto hits = first_hits(rays);
    for (std::size_t i = 0; i < rays.size(); ++i)  // a ray to the very edge may miss it by a rounding
      if (hits[i] && hits[i]->distance_mm < ways_mm[i] - border_mm()) return true;
    return false;
  }

  bool meet_again(std::span<const Node> nodes) {
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < nodes.size(); i += stride_)
      if (!(opening_ && opening_->lets_out(nodes[i].leaving))) rays.push_back(nodes[i].leaving);
    for (const auto& hit : first_hits(rays))
      if (hit && hit->distance_mm > border_mm()) return true;
    return false;
  }

 private:
  /// Hits nearer than that to a node are the node itself.
  double border_mm() const { return 1e3 * lift_mm_; }

  std::vector<std::optional<Hit>> first_hits(const std::vector<Ray>& rays) {
    std::vector<std::optional<Hit>> hits(rays.size());
    if (!rays.empty()) probe_->first_hits(rays, lift_mm_, hits);
    return hits;
  }

  bool stopped_by_field(const Ray& ray, double way_mm) const {
    const NearField& field = scene_.near_field;
    if (!field.material()) return false;
    const double distance =
        (field.center_mm() - ray.origin_mm).dot(field.normal()) / ray.direction.dot(field.normal());
    return distance > 0 && distance < way_mm &&
           field.contains(field.to_plane(ray.origin_mm + distance * ray.direction));
  }

  const Scene& scene_;
  std::unique_ptr<Probe> probe_;
  std::optional<Opening> opening_;
  double lift_mm_;
  std::size_t stride_;
};

/// What a grid of rays cannot tell.
std::optional<std::string> untold(const Scene& scene, UnknownBreaks unknown) {
  if (!scene.is_bare()) return "other things stand about, which may shade";
  if (scene.source.is_sampled()) return "the source is known by its rays alone";
  if (scene.source.extent_mm() > 0) return "the source is extended";
  if (dynamic_cast<const PointSource*>(&scene.source) == nullptr)
    return "the source's intensity may have steps";
  if (!is_specular(scene.mirror)) return "the mirror scatters, and a grid of rays does not";
  if (scene.mirror.transmittance > 0) return "light goes through the mirror, whose edges it shows";
  if (scene.near_field.material() && unknown != UnknownBreaks::folds)
    return "the near field is real and may shade the mirror";
  return std::nullopt;
}

}  // namespace

SmoothReach find_breaks(const Scene& scene, UnknownBreaks unknown, double enough_mm) {
  if (auto reason = untold(scene, unknown)) return {0, reason};
  SmoothReach reach;
  const auto nearer = [&](double clear_mm, const char* what) {
    if (clear_mm < reach.clear_mm) reach = {clear_mm, what};
  };
  Meetings meetings(scene);
  const auto stretches = smooth_stretches(scene.reflector.profile());
  constexpr std::size_t fewest_rows = 5;
  const std::size_t row_count = std::max(fewest_rows, rows_of_rays / stretches.size());
  for (const SmoothStretch& stretch : stretches) {
    const Sheet sheet(scene, stretch, row_count);
    if (meetings.hidden(sheet.inner_nodes())) nearer(0, "part of the mirror lies in a shadow");
    if (meetings.meet_again(sheet.inner_nodes())) nearer(0, "light meets the mirror more than once");
    if (reach.clear_mm == 0) break;
    if (unknown == UnknownBreaks::edges_and_folds) {
      const char* edge = "an edge of the beam lies on the near field or beside it";
      if (stretch.edge_at_begin) nearer(clear_of_circle(scene, stretch.begin, enough_mm), edge);
      if (stretch.edge_at_end) nearer(clear_of_circle(scene, stretch.end, enough_mm), edge);
    }
    nearer(sheet.clear_of_breaks(), "the beam has a fold or a focus on the near field or beside it");
  }
  return reach;
}

}  // namespace catoptric::sim
