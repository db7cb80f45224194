#include <GeomAdaptor_Curve.hxx>
#include <GeomAdaptor_Surface.hxx>
#include <Geom_Line.hxx>
#include <Geom_SurfaceOfRevolution.hxx>
#include <IntCurveSurface_HInter.hxx>
#include <IntCurveSurface_IntersectionPoint.hxx>
#include <Precision.hxx>
#include <algorithm>
#include <cmath>
#include <gp_Ax1.hxx>
#include <utility>

#include "base/float_traps.h"
#include "base/tolerance.h"
#include "cad/detail/occt_curve.h"
#include "cad/detail/occt_guard.h"
#include "cad/engines.h"

namespace catoptric::cad {
namespace {

/// The part as OCCT likes it: centred on the origin and some hundred units large, since OCCT's tolerances are
/// absolute. The factor is a power of two, so no digit of a pole changes.
struct OcctModel {
  explicit OcctModel(const Profile& profile)
      : centre_z_mm(0.5 * (profile.z_min_mm() + profile.z_max_mm())),
        scale(std::exp2(7 - std::ceil(std::log2(0.5 * profile.diagonal_mm())))),
        reach(1.001 * scale * 0.5 * profile.diagonal_mm()) {
    curve = detail::occt_curve(profile, scale);
    detail::guarded("revolve the generatrix", "", [&] {
      curve->Translate(gp_Vec(0., 0., -scale * centre_z_mm));
      surface = new Geom_SurfaceOfRevolution(curve, gp_Ax1(gp_Pnt(0., 0., 0.), gp_Dir(0., 0., 1.)));
    });
  }

  double centre_z_mm;
  double scale;  ///< model units per mm
  double reach;  ///< radius that holds the model
  Handle(Geom_BSplineCurve) curve;
  Handle(Geom_Surface) surface;
};

/// A ray in model units, its origin moved to where it passes nearest to the part.
struct ModelRay {
  Vector3 origin;
  Vector3 direction;
  long double shift_mm;  ///< distance along the given ray = shift + t / scale

  ModelRay(const Ray& ray, const OcctModel& model) : direction(ray.direction) {
    using Wide = Eigen::Matrix<long double, 3, 1>;
    const Wide d = ray.direction.cast<long double>();
    Wide o = ray.origin_mm.cast<long double>();
    o.z() -= model.centre_z_mm;
    shift_mm = -o.dot(d);
    origin = ((o + shift_mm * d) * model.scale).cast<double>();
  }
  Vector3 at(double t) const { return origin + t * direction; }
};

/// Where a ray meets the model: t along the ray, v on the generatrix.
struct Crossing {
  double t, v;
};

class OcctProbe final : public Probe {
 public:
  explicit OcctProbe(const OcctModel& model)
      : model_(model),
        surface_(new GeomAdaptor_Surface(model.surface)),
        first_(model.curve->FirstParameter()),
        last_(model.curve->LastParameter()) {}

  std::optional<Hit> first_hit(const Ray& ray, double beyond_mm) override {
    const std::vector<Hit> hits = all_hits(ray, beyond_mm);
    if (hits.empty()) return std::nullopt;
    return hits.front();
  }

  std::vector<Hit> all_hits(const Ray& ray, double beyond_mm) override {
    const UntrappedFloats untrapped;  // for rays that are no numbers
    const ModelRay line(ray, model_);
    const bool passes = line.origin.squaredNorm() <= model_.reach * model_.reach;
    if (!passes || !(line.direction.squaredNorm() > 0)) return {};  // also what is no number
    return detail::guarded("intersect a ray with the mirror", "", [&] {
      std::vector<Hit> hits;
      for (const Crossing& crossing : crossings(line)) {
        const Hit hit = dress(line, crossing);
        if (hit.distance_mm > beyond_mm) hits.push_back(hit);
      }
      return hits;
    });
  }

 private:
  std::vector<Crossing> crossings(const ModelRay& line);
  Crossing refine(const ModelRay& line, Crossing crossing) const;
  Crossing snap_to_vertex(const ModelRay& line, Crossing crossing) const;
  Vector2 tangent(double v) const;
  Hit dress(const ModelRay& line, const Crossing& crossing) const;

  const OcctModel& model_;
  Handle(GeomAdaptor_Surface) surface_;  // caches, so one for each probe
  IntCurveSurface_HInter intersector_;
  double first_, last_;
};

/// All hits in order, each once. OCCT returns the vertex some fifty times and a tangent up to three times.
std::vector<Crossing> OcctProbe::crossings(const ModelRay& line) {
  const gp_Pnt origin(line.origin.x(), line.origin.y(), line.origin.z());
  const gp_Dir direction(line.direction.x(), line.direction.y(), line.direction.z());
  const Handle(GeomAdaptor_Curve) segment =
      new GeomAdaptor_Curve(new Geom_Line(origin, direction), -model_.reach, model_.reach);
  intersector_.Perform(segment, surface_);
  std::vector<Crossing> found;
  if (!intersector_.IsDone()) return found;
  for (int i = 1; i <= intersector_.NbPoints(); ++i) {
    const IntCurveSurface_IntersectionPoint& point = intersector_.Point(i);
    found.push_back(snap_to_vertex(line, refine(line, {point.W(), point.V()})));
  }
  std::sort(found.begin(), found.end(), [](const Crossing& a, const Crossing& b) { return a.t < b.t; });
  const auto same = [](const Crossing& a, const Crossing& b) { return b.t - a.t <= Precision::Confusion(); };
  found.erase(std::unique(found.begin(), found.end(), same), found.end());
  return found;
}

/// Newton for |xy(t)| = R(v), z(t) = Z(v) on the true surface, kept as long as it comes nearer.
Crossing OcctProbe::refine(const ModelRay& line, Crossing crossing) const {
  constexpr int most_steps = 8;
  double best = HUGE_VAL;
  Crossing next = crossing;
  for (int i = 0; i < most_steps; ++i) {
    const Vector3 p = line.at(next.t);
    gp_Pnt at;
    gp_Vec speed;
    model_.curve->D1(next.v, at, speed);
    const double r = std::hypot(p.x(), p.y());
    const double g1 = r - at.X(), g2 = p.z() - at.Z();
    const double off = std::hypot(g1, g2);
    if (!(off < best)) break;
    best = off;
    crossing = next;
    const Vector3& d = line.direction;
    const double outward = r > 0 ? (p.x() * d.x() + p.y() * d.y()) / r : std::hypot(d.x(), d.y());
    const double determinant = d.z() * speed.X() - outward * speed.Z();
    if (determinant == 0) break;
    next.t += (g1 * speed.Z() - g2 * speed.X()) / determinant;
    next.v = std::clamp(next.v + (d.z() * g1 - outward * g2) / determinant, first_, last_);
  }
  return crossing;
}

/// A ray through the vertex to rounding hits the vertex itself: there the parametrization has no speed and
/// Newton no hold.
Crossing OcctProbe::snap_to_vertex(const ModelRay& line, Crossing crossing) const {
  const double rounding = Tolerance::for_scale(model_.reach).length_mm;
  for (const double end : {first_, last_}) {
    const gp_Pnt vertex = model_.curve->Value(end);
    if (vertex.X() > rounding) continue;
    const Vector3 to_vertex = Vector3(0, 0, vertex.Z()) - line.origin;
    const double t = to_vertex.dot(line.direction);
    const bool through = (to_vertex - t * line.direction).norm() <= 0.01 * rounding;
    if (through && std::abs(t - crossing.t) <= Precision::Confusion()) return {t, end};
  }
  return crossing;
}

/// Direction of the generatrix: the first derivative that does not vanish (repeated poles take its speed).
Vector2 OcctProbe::tangent(double v) const {
  const double rounding = Tolerance::for_scale(model_.reach).length_mm / (last_ - first_);
  for (int order = 1; order < model_.curve->Degree(); ++order) {
    const gp_Vec derivative = model_.curve->DN(v, order);
    const Vector2 direction(derivative.X(), derivative.Z());
    if (direction.norm() > rounding) return direction;
  }
  const gp_Vec derivative = model_.curve->DN(v, model_.curve->Degree());
  return {derivative.X(), derivative.Z()};
}

Hit OcctProbe::dress(const ModelRay& line, const Crossing& crossing) const {
  const gp_Pnt at = model_.curve->Value(crossing.v);
  const Vector3 p = line.at(crossing.t);
  Vector2 azimuth(p.x(), p.y());
  // On the axis any azimuth gives the point; the ray's meridian plane decides the normal of a cone's tip.
  if (!(at.X() > 0) || azimuth.norm() == 0) azimuth = {line.direction.x(), line.direction.y()};
  azimuth = azimuth.norm() > 0 ? Vector2(azimuth / azimuth.norm()) : Vector2(1, 0);
  const Vector2 along = tangent(crossing.v);
  Vector3 normal(along.y() * azimuth.x(), along.y() * azimuth.y(), -along.x());
  normal.normalize();
  if (normal.dot(line.direction) > 0) normal = -normal;
  const Vector3 point(at.X() * azimuth.x(), at.X() * azimuth.y(), at.Z());
  return {static_cast<double>(line.shift_mm + static_cast<long double>(crossing.t) / model_.scale),
          point / model_.scale + Vector3(0, 0, model_.centre_z_mm), normal, crossing.v};
}

class OcctReflector final : public Reflector {
 public:
  explicit OcctReflector(const Profile& profile) : profile_(profile), model_(profile_) {}
  std::unique_ptr<Probe> probe() const override {
    return detail::guarded("open the mirror", "", [&] { return std::make_unique<OcctProbe>(model_); });
  }
  const Profile& profile() const override { return profile_; }
  std::string_view engine() const override { return "occt"; }

 private:
  Profile profile_;
  OcctModel model_;
};

}  // namespace

std::unique_ptr<Reflector> make_occt_reflector(const Profile& profile) {
  return std::make_unique<OcctReflector>(profile);
}

}  // namespace catoptric::cad
