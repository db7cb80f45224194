#include "sim/projection_map.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/contract.h"
#include "base/profile_hull.h"
#include "base/units.h"
#include "base/vector_clones.h"
#include "sim/frame.h"

namespace catoptric::sim {
namespace {

struct Interval {
  double low, high;
};

/// Sorted and merged; the parts that remain do not touch.
std::vector<Interval> unite(std::vector<Interval> parts) {
  std::sort(parts.begin(), parts.end(), [](const Interval& a, const Interval& b) { return a.low < b.low; });
  std::vector<Interval> united;
  for (const Interval& part : parts) {
    if (!united.empty() && part.low <= united.back().high)
      united.back().high = std::max(united.back().high, part.high);
    else
      united.push_back(part);
  }
  return united;
}

double measure(const std::vector<Interval>& parts) {
  double sum = 0;
  for (const Interval& part : parts) sum += part.high - part.low;
  return sum;
}

double polar_cosine(double r_mm, double z_mm) { return z_mm / std::hypot(r_mm, z_mm); }

/// Halvings that cut a profile of many spans into no more pieces than one of few.
int halvings_for(const Profile& profile, int pieces) {
  int halvings = 0;
  while ((profile.spans().size() << halvings) < static_cast<std::size_t>(pieces)) ++halvings;
  return halvings;
}

/// Cosines under which the boxes are seen from the points of a level disc about (0, source_z); nothing when
/// one of them may lie in a box. The ways to a box end, seen from a common origin, in a box that is wider by
/// the disc's radius; it is convex and lies in r >= 0, so its extreme polar angles are at corners.
std::optional<std::vector<Interval>> seen_boxes(const std::vector<HullBox>& boxes, double source_z_mm,
                                                double radius_mm) {
  // A cosine is good to 2 roundings; 8 of them more on either side keep the border directions in.
  constexpr double slack = 8 * 2.220446049250313e-16;
  std::vector<Interval> seen;
  for (const HullBox& box : boxes) {
    const double r0 = std::max(0.0, box.r_min_mm - radius_mm), r1 = std::max(r0, box.r_max_mm + radius_mm);
    const double z0 = box.z_min_mm - source_z_mm, z1 = box.z_max_mm - source_z_mm;
    if (r0 == 0 && z0 <= 0 && z1 >= 0) return std::nullopt;
    const auto [low, high] =
        std::minmax({polar_cosine(r0, z0), polar_cosine(r0, z1), polar_cosine(r1, z0), polar_cosine(r1, z1)});
    seen.push_back({std::max(-1.0, low - slack), std::min(1.0, high + slack)});
  }
  return unite(std::move(seen));
}

/// Cosines that are certainly covered: the curve is continuous, so it covers what lies between the ends of
/// each piece.
double certain_measure(const Profile& profile, const std::vector<HullBox>& boxes, double source_z_mm) {
  std::vector<Interval> covered;
  for (const HullBox& box : boxes) {
    const MeridianPoint a = profile.at(box.first), b = profile.at(box.last);
    const auto [low, high] =
        std::minmax({polar_cosine(a.r_mm, a.z_mm - source_z_mm), polar_cosine(b.r_mm, b.z_mm - source_z_mm)});
    covered.push_back({low, high});
  }
  return measure(unite(std::move(covered)));
}

/// A ball that holds a sector of a revolved box, about the source.
struct Ball {
  Vector3 center_mm;
  double radius_mm;
};

/// Balls about all ways from points of the source to points of the mirror.
std::vector<Ball> cover_with_balls(const Profile& profile, const Vector3& source_mm,
                                   double source_radius_mm) {
  constexpr int pieces = 64, sectors = 128;
  const double half_sector = pi / sectors;
  std::vector<Ball> balls;
  for (const HullBox& box : hull_boxes(profile, halvings_for(profile, pieces))) {
    const double r0 = std::max(0.0, box.r_min_mm), r1 = std::max(r0, box.r_max_mm);
    const double middle_r = 0.5 * (r0 + r1);
    const auto square_at = [&](double r) {
      return r * r + middle_r * middle_r - 2 * r * middle_r * std::cos(half_sector);
    };
    const double half_z = 0.5 * (box.z_max_mm - box.z_min_mm);
    const double radius = std::sqrt(std::max(square_at(r0), square_at(r1)) + half_z * half_z);
    for (int sector = 0; sector < sectors; ++sector) {
      const double azimuth = (2 * sector + 1) * half_sector;
      const Vector3 center(middle_r * std::cos(azimuth), middle_r * std::sin(azimuth),
                           0.5 * (box.z_min_mm + box.z_max_mm));
      balls.push_back({center - source_mm, radius + source_radius_mm});
    }
  }
  return balls;
}

/// The cone under which a ball is seen, in the map's frame.
struct Cone {
  double polar_rad, azimuth_rad, half_angle_rad;
};

/// Nothing when the source is inside a ball.
std::optional<std::vector<Cone>> cones_of(const std::vector<Ball>& balls, const Eigen::Matrix3d& frame) {
  // asin loses half the digits near 1; 1e-7 rad covers that loss (1.5e-8) and costs no visible waste.
  constexpr double slack_rad = 1e-7;
  std::vector<Cone> cones;
  cones.reserve(balls.size());
  for (const Ball& ball : balls) {
    const double distance = ball.center_mm.norm();
    if (!(ball.radius_mm < distance)) return std::nullopt;
    const Vector3 local = frame.transpose() * ball.center_mm;
    double azimuth = std::atan2(local.y(), local.x());
    if (azimuth < 0) azimuth += 2 * pi;
    cones.push_back({std::atan2(std::hypot(local.x(), local.y()), local.z()), azimuth,
                     std::asin(ball.radius_mm / distance) + slack_rad});
  }
  return cones;
}

/// Cells of equal light round the polar axis: rows in the cosine from `high` down to `low`, columns in
/// azimuth.
class CellGrid {
 public:
  CellGrid(const CosineLaw& law, double low, double high)
      : law_(law), least_(law.integral(low)), most_(law.integral(high)), marks_(rows * columns, 0) {}

  static constexpr int rows = 64, columns = 128;

  bool has_light() const { return most_ > least_; }
  double cosine_above(int row) const { return law_.inverse(most_ - (most_ - least_) * row / rows); }
  bool marked(int row, int column) const { return marks_[static_cast<std::size_t>(row * columns + column)]; }

  /// Marks every cell that the rectangle of polar angle and azimuth round the cone touches.
  void mark(const Cone& cone) {
    const double least = cone.polar_rad - cone.half_angle_rad, most = cone.polar_rad + cone.half_angle_rad;
    if (!law_.lights_behind() && least >= 0.5 * pi) return;  // behind the source
    const int top = row_of(least <= 0 ? 1.0 : std::cos(least));
    const int bottom = row_of(most >= pi ? -1.0 : std::cos(most));
    int first = 0, count = columns;
    if (least > 0 && most < pi && cone.half_angle_rad < 0.5 * pi) {
      const double spread =
          std::asin(std::min(1.0, std::sin(cone.half_angle_rad) / std::sin(cone.polar_rad)));
      constexpr double per_rad = columns / (2 * pi);
      first = static_cast<int>(std::floor((cone.azimuth_rad - spread) * per_rad));
      const int last = static_cast<int>(std::floor((cone.azimuth_rad + spread) * per_rad));
      count = std::min(columns, last - first + 1);
    }
    for (int row = top; row <= bottom; ++row)
      for (int step = 0; step < count; ++step) {
        const int column = ((first + step) % columns + columns) % columns;
        marks_[static_cast<std::size_t>(row * columns + column)] = 1;
      }
  }

 private:
  int row_of(double cosine) const {
    const double share = (most_ - law_.integral(cosine)) / (most_ - least_);
    return std::clamp(static_cast<int>(std::floor(share * rows)), 0, rows - 1);
  }

  CosineLaw law_;
  double least_, most_;  ///< the law's integral at `low` and `high`
  std::vector<char> marks_;
};

struct BandNumbers {
  double before_sr, whole_sr, width_rad, low, high;
};

/// Sets the law's integrals (or cosines where they are the same) of the numbers that fall into a band or
/// beyond it.
CATOPTRIC_VECTOR_CLONES
void set_band(const BandNumbers& band, std::size_t count, const double* __restrict first,
              double* __restrict cosines) {
  const double before = band.before_sr, whole = band.whole_sr, width = band.width_rad;
  const double low = band.low, high = band.high;
  for (std::size_t i = 0; i < count; ++i) {
    const double target = first[i] * whole;
    const double inside = low + (target - before) / width;
    const double cosine = inside < low ? low : inside > high ? high : inside;
    cosines[i] = target >= before ? cosine : cosines[i];
  }
}

}  // namespace

void ProjectionMap::add_band(double low, double high, std::vector<Arc> arcs) {
  double width = 0;
  for (const Arc& arc : arcs) width += arc.length_rad;
  if (!(high > low)) return;
  const double from = law_.integral(low), light = (law_.integral(high) - from) * width;
  if (!(light > 0)) return;
  bands_.push_back({low, high, light_sr_, width, from, std::move(arcs)});
  light_sr_ += light;
  solid_angle_sr_ += (high - low) * width;
}

ProjectionMap ProjectionMap::whole_sphere() { return all_lit(Emitter{Vector3::Zero()}); }

ProjectionMap ProjectionMap::all_lit(const Emitter& emitter) {
  ProjectionMap map(emitter.law);
  const Vector3& axis = emitter.axis;
  const bool level = axis.x() == 0 && axis.y() == 0, down = level && axis.z() < 0;
  if (!emitter.law.is_even() && !level) map.frame_ = frame_about(axis);
  const bool both = emitter.law.lights_behind();
  map.add_band(both || down ? -1 : 0, !both && down ? 0 : 1, {{0, 2 * pi}});
  return map;
}

ProjectionMap ProjectionMap::towards(const Profile& profile, const Emitter& emitter) {
  const Vector3 &at = emitter.center_mm, &axis = emitter.axis;
  const bool is_level_disc = emitter.is_flat && axis.x() == 0 && axis.y() == 0;
  const bool straight = emitter.law.is_even() ? emitter.radius_mm == 0 : is_level_disc;
  ProjectionMap map =
      at.x() == 0 && at.y() == 0 && straight ? from_axis(profile, emitter) : from_aside(profile, emitter);
  return map.bands_.empty() ? all_lit(emitter) : map;
}

ProjectionMap ProjectionMap::from_axis(const Profile& profile, const Emitter& emitter) {
  constexpr double most_waste = 0.005;
  constexpr int first_pieces = 32, most_pieces = 2048;
  const double z_mm = emitter.center_mm.z();
  std::vector<Interval> seen;
  for (int pieces = first_pieces; pieces <= most_pieces; pieces *= 4) {
    const auto boxes = hull_boxes(profile, halvings_for(profile, pieces));
    const auto found = seen_boxes(boxes, z_mm, 0);
    auto wider = seen_boxes(boxes, z_mm, emitter.radius_mm);
    if (!found || !wider) {  // a smaller box may leave the source out
      seen.clear();
      continue;
    }
    seen = std::move(*wider);
    if (measure(*found) - certain_measure(profile, boxes, z_mm) <= most_waste * measure(*found)) break;
  }
  ProjectionMap map(emitter.law);
  const bool both = emitter.law.lights_behind(), down = emitter.axis.z() < 0;
  const double low = both || down ? -1 : 0, high = !both && down ? 0 : 1;
  for (const Interval& part : seen)
    map.add_band(std::max(low, part.low), std::min(high, part.high), {{0, 2 * pi}});
  return map;
}

ProjectionMap ProjectionMap::from_aside(const Profile& profile, const Emitter& emitter) {
  const Vector3 center(0, 0, 0.5 * (profile.z_min_mm() + profile.z_max_mm()));
  const Vector3 way = center - emitter.center_mm;
  const bool even = emitter.law.is_even(), both = emitter.law.lights_behind();
  ProjectionMap map(emitter.law);
  // From near the centre every axis is as good; z keeps the rim parallel to the rows.
  constexpr double near_share = 0.01;
  map.frame_ = frame_about(!even                                             ? emitter.axis
                           : way.norm() > near_share * profile.diagonal_mm() ? way
                                                                             : Vector3::UnitZ());
  const auto cones = cones_of(cover_with_balls(profile, emitter.center_mm, emitter.radius_mm), map.frame_);
  if (!cones) return map;
  double widest_rad = 0, narrowest_rad = pi;
  for (const Cone& cone : *cones) {
    widest_rad = std::max(widest_rad, cone.polar_rad + cone.half_angle_rad);
    narrowest_rad = std::min(narrowest_rad, cone.polar_rad - cone.half_angle_rad);
  }
  const double farthest_rad = both ? pi : 0.5 * pi;
  const double low = std::cos(std::min(farthest_rad, widest_rad));
  CellGrid grid(emitter.law, std::max(both ? -1.0 : 0.0, low),
                even ? 1.0 : std::cos(std::clamp(narrowest_rad, 0.0, farthest_rad)));
  if (!grid.has_light()) return map;
  for (const Cone& cone : *cones) grid.mark(cone);

  const double column_rad = 2 * pi / CellGrid::columns;
  for (int row = CellGrid::rows - 1; row >= 0; --row) {
    std::vector<Arc> arcs;
    bool open = false;
    for (int column = 0; column < CellGrid::columns; ++column) {
      const bool marked = grid.marked(row, column);
      if (marked && open) arcs.back().length_rad += column_rad;
      if (marked && !open) arcs.push_back({column * column_rad, column_rad});
      open = marked;
    }
    map.add_band(grid.cosine_above(row + 1), grid.cosine_above(row), std::move(arcs));
  }
  return map;
}

Vector3 ProjectionMap::direction(double first, double second) const {
  const double target_sr = first * light_sr_;
  const auto after = std::upper_bound(bands_.begin() + 1, bands_.end(), target_sr,
                                      [](double value, const Band& band) { return value < band.before_sr; });
  const Band& band = *std::prev(after);
  const double integral = std::clamp(band.from + (target_sr - band.before_sr) / band.width_rad, band.from,
                                     law_.integral(band.high));
  const double cosine = std::clamp(law_.inverse(integral), bands_.front().low, bands_.back().high);
  double along = second * band.width_rad;
  std::size_t arc = 0;
  while (arc + 1 < band.arcs.size() && along >= band.arcs[arc].length_rad)
    along -= band.arcs[arc++].length_rad;
  const double azimuth = band.arcs[arc].first_rad + along;
  const double sine = std::sqrt((1 - cosine) * (1 + cosine));
  return frame_ * Vector3(sine * std::cos(azimuth), sine * std::sin(azimuth), cosine);
}

bool ProjectionMap::about_axis() const {
  return frame_ == Eigen::Matrix3d::Identity() &&
         std::all_of(bands_.begin(), bands_.end(),
                     [](const Band& band) { return band.arcs.size() == 1 && band.width_rad == 2 * pi; });
}

void ProjectionMap::cosines(std::span<const double> first, std::span<double> cosines) const {
  CATOPTRIC_EXPECTS(about_axis() && first.size() == cosines.size());
  for (const Band& band : bands_)
    set_band({band.before_sr, light_sr_, band.width_rad, band.from, law_.integral(band.high)}, first.size(),
             first.data(), cosines.data());
  if (law_.is_even()) return;
  const auto &lowest = bands_.front(), &highest = bands_.back();
  for (double& cosine : cosines) cosine = std::clamp(law_.inverse(cosine), lowest.low, highest.high);
}

bool ProjectionMap::contains(const Vector3& direction) const {
  const Vector3 local = frame_.transpose() * direction.normalized();
  double azimuth = std::atan2(local.y(), local.x());
  if (azimuth < 0) azimuth += 2 * pi;
  const double cosine = std::clamp(local.z(), -1.0, 1.0);
  return std::any_of(bands_.begin(), bands_.end(), [&](const Band& band) {
    return cosine >= band.low && cosine <= band.high &&
           std::any_of(band.arcs.begin(), band.arcs.end(), [azimuth](const Arc& arc) {
             return azimuth >= arc.first_rad && azimuth <= arc.first_rad + arc.length_rad;
           });
  });
}

bool ProjectionMap::touches(const Vector3& direction, double half_angle_rad) const {
  constexpr double slack_rad = 1e-9;
  const double half = half_angle_rad + slack_rad;
  const Vector3 local = frame_.transpose() * direction.normalized();
  const double polar = std::atan2(std::hypot(local.x(), local.y()), local.z());
  double azimuth = std::atan2(local.y(), local.x());
  if (azimuth < 0) azimuth += 2 * pi;
  const double high = polar > half ? std::cos(polar - half) : 1,
               low = polar < pi - half ? std::cos(polar + half) : -1;
  const bool round_pole = polar <= half || polar >= pi - half;
  const double spread = round_pole ? pi : std::asin(std::min(1.0, std::sin(half) / std::sin(polar)));
  return std::any_of(bands_.begin(), bands_.end(), [&](const Band& band) {
    return band.low <= high && band.high >= low &&
           std::any_of(band.arcs.begin(), band.arcs.end(), [&](const Arc& arc) {
             const double off = std::remainder(azimuth - (arc.first_rad + 0.5 * arc.length_rad), 2 * pi);
             return std::abs(off) <= 0.5 * arc.length_rad + spread;
           });
  });
}

}  // namespace catoptric::sim
