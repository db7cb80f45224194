#include <fmt/format.h>

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <memory>
#include <tuple>

#include "base/planar_hits.h"
#include "cad/engines.h"
#include "support/cad/exact_hits.h"
#include "support/cad/rays.h"

/// Every engine on every kind of generatrix and ray that intersectors are known to fail on, judged by
/// polynomials in a hundred digits.
using namespace catoptric;
using namespace catoptric::test;

namespace {

struct Shape {
  std::string name;
  int degree;
  std::vector<double> knots;
  std::vector<ControlPoint> points;  ///< 10 in radius or height

  Profile at(double scale) const {
    std::vector<ControlPoint> scaled = points;
    for (ControlPoint& point : scaled) {
      point.r_mm *= scale;
      point.z_mm *= scale;
    }
    return Profile(degree, knots, scaled);
  }
};

Shape bezier(std::string name, std::vector<ControlPoint> points) {
  const int degree = static_cast<int>(points.size()) - 1;
  return {std::move(name), degree, Profile::uniform_knots(degree, points.size()), std::move(points)};
}

std::vector<Shape> shapes() {
  const double half = std::sqrt(0.5);
  std::vector<Shape> list{
      bezier("paraboloid", {{0, 10, 1}, {5, 10, 1}, {10, 5, 1}}),
      bezier("half sphere", {{0, 10, 1}, {10, 10, half}, {10, 0, 1}}),
      bezier("collinear: a cone of degree 2", {{0, 10, 1}, {5, 7.5, 1}, {10, 5, 1}}),
      bezier("collinear and uneven: the cone, weights 1e8 and 1e-8",
             {{0, 10, 1e8}, {5, 7.5, 1}, {10, 5, 1e-8}}),
      bezier("collinear upright: a cylinder of degree 2", {{3, 12, 1}, {3, 7, 2}, {3, 2, 1}}),
      bezier("collinear level: a disc of degree 3", {{0, 10, 1}, {2, 10, 3}, {5, 10, 1}, {10, 10, 1}}),
      bezier("coincident at the vertex", {{0, 10, 1}, {0, 10, 1}, {0, 10, 2}, {5, 10, 1}, {10, 5, 1}}),
      bezier("coincident at the rim", {{0, 10, 1}, {5, 10, 1}, {10, 5, 1}, {10, 5, 3}}),
      bezier("coincident inside", {{0, 10, 1}, {5, 10, 1}, {5, 10, 1}, {10, 5, 1}}),
      bezier("touches the axis inside", {{5, 0, 1}, {-5, 5, 1}, {5, 10, 1}}),
      bezier("pierced, rims at 2 and 10", {{2, 9, 1}, {6, 10, 1}, {10, 5, 1}}),
      {"ball, both ends on the axis",
       2,
       {0, 0, 0, 1, 1, 2, 2, 2},
       {{0, 10, 1}, {5, 10, half}, {5, 5, 1}, {5, 0, half}, {0, 0, 1}}},
      {"wave of degree 5, nine spans", 5, {}, {}},
      {"uneven weights of degree 3",
       3,
       Profile::uniform_knots(3, 6),
       {{0, 10, 1e-8}, {3, 10, 1}, {6, 9, 1e8}, {8, 7, 1}, {9, 4, 1e8}, {10, 1, 1e-8}}},
  };
  for (int i = 0; i <= 13; ++i)
    list[12].points.push_back(
        {10 * std::sin(i / 13.0), 10 * std::cos(i / 13.0) + (i > 1) * 0.4 * (i % 2), 1 + 0.3 * (i % 3)});
  list[12].points[0].r_mm = 0;
  list[12].knots = Profile::uniform_knots(5, 14);
  for (const double w : {1e-8, 1e-4, 1e4, 1e8}) {
    list.push_back(bezier(fmt::format("middle weight {:.0e}", w), {{0, 10, 1}, {5, 10, w}, {10, 5, 1}}));
    list.push_back(bezier(fmt::format("first weight {:.0e}", w), {{0, 10, w}, {5, 10, 1}, {10, 5, 1}}));
    list.push_back(bezier(fmt::format("last weight {:.0e}", w), {{0, 10, 1}, {5, 10, 1}, {10, 5, w}}));
  }
  return list;
}

struct NamedRay {
  const char* kind;
  Ray ray;
  bool in_plane = false;  ///< in the plane y = 0
};

/// A parameter anywhere in the span, also as near to its ends as doubles go.
double parameter(const Profile& profile, RandomStream& random) {
  const double a = profile.first_parameter(), b = profile.last_parameter();
  const double choice = random.uniform(), tiny = std::pow(10.0, -12 * random.uniform());
  if (choice < 0.25) return a + (b - a) * tiny;
  if (choice < 0.5) return b - (b - a) * tiny;
  return a + (b - a) * random.uniform();
}

/// @in number of rays of each kind
std::vector<NamedRay> rays(const Profile& profile, std::uint64_t seed, int number) {
  std::vector<NamedRay> list;
  const double size = profile.diagonal_mm(), middle = 0.5 * (profile.z_min_mm() + profile.z_max_mm());
  const double r = profile.r_max_mm();
  for (const double side : {1.0, -1.0})
    for (const double away : {1e-3, 1.0, 1e6})
      list.push_back({"axial", {{0, 0, middle - side * away * size}, {0, 0, side}}, true});
  for (int i = 0; i < number; ++i) {
    RandomStream random(seed, Purpose::test, static_cast<std::uint64_t>(i));
    const double u = parameter(profile, random), phi = i % 2 ? 2 * pi * random.uniform() : 0;
    const Vector3 on = surface_point(profile, u, phi);
    const double power = std::pow(10.0, -16 * random.uniform());
    const double side = random.uniform() < 0.5 ? -1 : 1;
    const double height = profile.z_min_mm() + (profile.z_max_mm() - profile.z_min_mm()) * random.uniform();
    list.push_back({"near the axis", {{power * size, 0, middle - side * 3 * size}, {0, 0, side}}, true});
    list.push_back(
        {"parallel, to the rim", {{r * (1 - power), 0, middle - side * 3 * size}, {0, 0, side}}, true});
    const Vector3 axis_point(0, 0, middle + size * (4 * random.uniform() - 2));
    if ((on - axis_point).norm() > 0)
      list.push_back({"from the axis", {axis_point, (on - axis_point).normalized()}, i % 2 == 0});
    const Vector3 aside = size * (random.uniform() + 0.1) * random_direction(random);
    list.push_back({"from aside", {on - aside, aside.normalized()}});
    const Vector3 far = 1e6 * size * random_direction(random);
    list.push_back({"from a million sizes away", {on - far, far.normalized()}});
    const Vector3 close = 1e-3 * size * random_direction(random);
    list.push_back({"from a thousandth of the size away", {on - close, close.normalized()}});
    list.push_back({"from the surface itself", {on, random_direction(random)}});
    const Vector3 level = Vector3(std::cos(phi), std::sin(phi), i % 3 ? side * power : 0).normalized();
    list.push_back({"level or nearly", {Vector3(0, i % 2 ? 0.3 * r : 0, height) - 3 * size * level, level}});
    const MeridianPoint p = profile.at(u);
    const double speed = std::hypot(p.dr, p.dz);
    if (!(speed > 0)) continue;
    const Vector3 normal = Vector3(-p.dz * std::cos(phi), -p.dz * std::sin(phi), p.dr) / speed;
    const Vector3 across(-std::sin(phi), std::cos(phi), 0);
    const double turn = 2 * pi * random.uniform();
    const Vector3 tangent = std::cos(turn) * across + std::sin(turn) * across.cross(normal);
    list.push_back(
        {"grazing", {on + side * power * size * normal - 2 * size * tangent, tangent.normalized()}});
  }
  return list;
}

/// What was counted and the greatest of what was measured, over the part's size.
struct Sums {
  std::size_t rays = 0, hits = 0, doubtful = 0, lost = 0, invented = 0;
  double off = 0, normal = 0;
};

void add(const Sums& one, Sums& all) {
  all = {all.rays + one.rays,
         all.hits + one.hits,
         all.doubtful + one.doubtful,
         all.lost + one.lost,
         all.invented + one.invented,
         std::max(all.off, one.off),
         std::max(all.normal, one.normal)};
}

void print(const char* engine, const std::string& what, const Sums& s) {
  fmt::print("| {} | {} | {} rays, {} hits | {} lost, {} invented, {} left out | {:.1e} | {:.1e} |\n", engine,
             what, s.rays, s.hits, s.lost, s.invented, s.doubtful, s.off, s.normal);
}

/// Greatest over least weight of those that act together.
double weight_ratio(const Profile& profile) {
  double ratio = 1;
  const auto& points = profile.points();
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = i; j < points.size() && j <= i + static_cast<std::size_t>(profile.degree()); ++j)
      ratio = std::max({ratio, points[i].weight / points[j].weight, points[j].weight / points[i].weight});
  return ratio;
}

/// Whether the ray passes a free end of the generatrix within rounding: either answer is right.
bool at_the_rim(const Profile& profile, const Ray& ray, double within) {
  for (const double u : {profile.first_parameter(), profile.last_parameter()}) {
    const MeridianPoint end = profile.at(u);
    if (end.r_mm == 0) continue;
    const double height = end.z_mm - ray.origin_mm.z(), dz = ray.direction.z();
    if (std::abs(dz) <= within) {
      if (std::abs(height) <= 4 * within * profile.diagonal_mm()) return true;
      continue;
    }
    const Vector3 there = ray.origin_mm + height / dz * ray.direction;
    if (std::abs(std::hypot(there.x(), there.y()) - end.r_mm) * std::abs(dz) <=
        within * profile.diagonal_mm())
      return true;
  }
  return false;
}

struct Truth {
  std::vector<ExactHit> ahead;
  bool doubtful = false;  ///< a tangent, a start on the surface, the rim, or a ray in the surface
};

Truth truth_of(const ExactHits& exact, const Profile& profile, const Ray& ray) {
  Truth truth;
  const double size = profile.diagonal_mm();
  truth.doubtful = at_the_rim(profile, ray, 1e-13);
  for (const ExactHit& hit : exact(ray, -HUGE_VAL)) {
    const bool on_axis = hit.x == 0 && hit.y == 0;
    truth.doubtful =
        truth.doubtful || hit.touch || abs(hit.distance) < 1e-12 * size || (hit.cosine == 0 && !on_axis);
    if (hit.distance > 0) truth.ahead.push_back(hit);
  }
  return truth;
}

void measure(const ExactHit& exact, const Vector3& point, const Vector3& normal, double size, Sums& sums) {
  const Exact x = exact.x - point.x(), y = exact.y - point.y(), z = exact.z - point.z();
  const double off = static_cast<double>(sqrt(x * x + y * y + z * z)) / size;
  sums.off = std::max(sums.off, off * exact.cosine);
  const Exact radius = sqrt(exact.x * exact.x + exact.y * exact.y);
  if ((exact.tr == 0 && exact.tz == 0) || !(radius > 1e-9 * size)) return;
  const Vector3 right(static_cast<double>(exact.tz * exact.x / radius),
                      static_cast<double>(exact.tz * exact.y / radius), static_cast<double>(-exact.tr));
  sums.normal = std::max(sums.normal, std::min((right - normal).norm(), (right + normal).norm()));
}

/// Engines that promise every hit, and each once.
template <typename Hits>
void judge_strictly(const Truth& truth, const Profile& profile, const Hits& found, Sums& sums) {
  ++sums.rays;
  sums.hits += truth.ahead.size();
  if (truth.doubtful) {
    ++sums.doubtful;
    return;
  }
  if (found.size() < truth.ahead.size()) sums.lost += truth.ahead.size() - found.size();
  if (found.size() > truth.ahead.size()) sums.invented += found.size() - truth.ahead.size();
  if (found.size() != truth.ahead.size()) return;
  for (std::size_t i = 0; i < found.size(); ++i)
    measure(truth.ahead[i], found[i].point_mm, found[i].normal, profile.diagonal_mm(), sums);
}

/// Engines that may lose what grazes: hits farther from the surface and not at its very rim must be there,
/// and whatever is found must lie on ray and surface.
void judge_loosely(double least_cosine, const Truth& truth, const Profile& profile, const Ray& ray,
                   const std::vector<Hit>& found, Sums& sums) {
  const double size = profile.diagonal_mm();
  ++sums.rays;
  if (at_the_rim(profile, ray, 1e-6)) {
    ++sums.doubtful;
    return;
  }
  for (const Hit& hit : found) sums.invented += backward_error(profile, ray, hit) > 1e-9 * size;
  for (const ExactHit& exact : truth.ahead) {
    if (exact.cosine < least_cosine || abs(exact.distance) < 1e-9 * size) continue;
    ++sums.hits;
    const Vector3 place(static_cast<double>(exact.x), static_cast<double>(exact.y),
                        static_cast<double>(exact.z));
    const auto nearest = std::min_element(found.begin(), found.end(), [&](const Hit& a, const Hit& b) {
      return (a.point_mm - place).norm() < (b.point_mm - place).norm();
    });
    if (nearest == found.end() || (nearest->point_mm - place).norm() > 1e-6 * size)
      ++sums.lost;
    else
      measure(exact, nearest->point_mm, nearest->normal, size, sums);
  }
}

/// Hits in the plane y = 0 in the words of space.
std::vector<Hit> in_plane(const PlanarMirror& mirror, const Ray& ray) {
  std::vector<PlanarHit> hits;
  mirror.all_hits({ray.origin_mm.x(), ray.origin_mm.z(), ray.direction.x(), ray.direction.z()}, 0, hits);
  std::vector<Hit> found;
  for (const PlanarHit& hit : hits) {
    const Vector3 point(hit.x_mm, 0, hit.z_mm);
    // On the axis both sides of the section are the same point of the mirror.
    if (!found.empty() && hit.x_mm == 0 && found.back().point_mm == point) continue;
    found.push_back({hit.distance_mm, point, {hit.tz, 0, -hit.tx}, hit.parameter});
  }
  return found;
}

constexpr double sizes[] = {1e-5, 1, 1e4};  // extents of some 300 nm, 30 mm and 300 m

/// Asks about every kind of ray on every shape and size: `judge(profile, kind, ray, in plane, truth)`.
template <typename Judge>
void for_all(int number, const Judge& judge) {
  for (const Shape& shape : shapes())
    for (const double scale : sizes) {
      const Profile profile = shape.at(scale);
      const ExactHits exact(profile);
      const auto judge_one = judge(profile);
      for (const NamedRay& each : rays(profile, 7, number))
        judge_one(each, truth_of(exact, profile, each.ray));
    }
}

/// A rounding of the parameter, near the end of a span, moves a point by so much of the part.
double allowed(double ratio) { return 1e-13 + 2e-16 * ratio; }

}  // namespace

TEST_CASE("meridian and the plane's section find every hit of every shape, ray and size, as exact numbers do",
          "[extremes]") {
  std::map<std::string, Sums> meridian, planar;
  for_all(4, [&](const Profile& profile) {
    const std::shared_ptr<const Reflector> reflector = cad::make_meridian_reflector(profile);
    const std::shared_ptr<Probe> probe = reflector->probe();
    const auto section = std::make_shared<PlanarMirror>(profile);
    const double ratio = weight_ratio(profile);
    return [=, kept = reflector, &meridian, &planar, &profile](const NamedRay& each, const Truth& truth) {
      if (ratio > 2e8) return;  // refused in scenes
      INFO("weights " << ratio << ", size " << profile.diagonal_mm() << ", " << each.kind);
      const auto take = [&](const std::vector<Hit>& found, std::map<std::string, Sums>& table) {
        Sums one;
        judge_strictly(truth, profile, found, one);
        CHECK(one.lost + one.invented == 0);
        // A level ray meets both sides at nearly one parameter, which weights of 1e8 leave too few digits.
        const bool both_sides = std::string(each.kind) == "level or nearly" && ratio > 1e6;
        if (!both_sides) CHECK(one.off <= allowed(ratio));
        Sums& sums = table[fmt::format("{}, weights up to {:.0e}", each.kind,
                                       ratio > 1e5  ? 1e8
                                       : ratio > 10 ? 1e4
                                                    : 10)];
        add(one, sums);
      };
      take(probe->all_hits(each.ray, 0), meridian);
      if (each.in_plane) take(in_plane(*section, each.ray), planar);
    };
  });
  for (const auto& [what, sums] : meridian) print("meridian", what, sums);
  for (const auto& [what, sums] : planar) print("plane section", what, sums);
}

TEST_CASE("occt and mesh lose nothing that does not graze and invent nothing, whatever shape and size",
          "[extremes][long]") {
  std::map<std::string, Sums> occt, mesh;
  for_all(1, [&](const Profile& profile) {
    const std::shared_ptr<const Reflector> reference = cad::make_occt_reflector(profile),
                                           facets = cad::make_mesh_reflector(profile, {1e-3, {}, 1e-14});
    const std::shared_ptr<Probe> slow = reference->probe(), fast = facets->probe();
    const double ratio = weight_ratio(profile);
    return [=, kept = std::pair(reference, facets), &occt, &mesh, &profile](const NamedRay& each,
                                                                            const Truth& truth) {
      const std::string group = ratio > 1e5 ? "1e8" : ratio > 10 ? "1e4" : "10";
      INFO("weights " << ratio << ", size " << profile.diagonal_mm() << ", " << each.kind);
      // OCCT tells hits apart by 1e-9 of the part; facets of a chord error of 1e-3 stand up to that beside
      // the surface, which a ray sees whole below a sine of 0.1.
      const std::tuple<Probe*, std::map<std::string, Sums>*, double> engines[] = {{slow.get(), &occt, 0.05},
                                                                                  {fast.get(), &mesh, 0.3}};
      for (const auto& [probe, table, least_cosine] : engines) {
        Sums one;
        judge_loosely(least_cosine, truth, profile, each.ray, probe->all_hits(each.ray, 0), one);
        if (ratio < 100) CHECK(one.lost + one.invented == 0);
        if (ratio < 100) CHECK(one.off <= 1e-10);
        add(one, (*table)[fmt::format("{}, weights up to {}", each.kind, group)]);
      }
    };
  });
  for (const auto& [what, sums] : occt) print("occt", what, sums);
  for (const auto& [what, sums] : mesh) print("mesh", what, sums);
}
