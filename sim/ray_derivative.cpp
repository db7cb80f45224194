#include "sim/ray_derivative.h"

#include <algorithm>
#include <cmath>

#include "base/tolerance.h"

namespace catoptric::sim {
namespace {

constexpr std::size_t n = variables_at_once;

Jet operator+(const Jet& a, const Jet& b) {
  Jet c{a.v + b.v, a.t + b.t, {}, {}};
  for (std::size_t i = 0; i < n; ++i) {
    c.x[i] = a.x[i] + b.x[i];
    c.tx[i] = a.tx[i] + b.tx[i];
  }
  return c;
}

Jet operator*(double s, const Jet& a) {
  Jet c{s * a.v, s * a.t, {}, {}};
  for (std::size_t i = 0; i < n; ++i) {
    c.x[i] = s * a.x[i];
    c.tx[i] = s * a.tx[i];
  }
  return c;
}

Jet operator-(const Jet& a, const Jet& b) { return a + (-1.0) * b; }

Jet operator*(const Jet& a, const Jet& b) {
  Jet c{a.v * b.v, a.t * b.v + a.v * b.t, {}, {}};
  for (std::size_t i = 0; i < n; ++i) {
    c.x[i] = a.x[i] * b.v + a.v * b.x[i];
    c.tx[i] = a.tx[i] * b.v + a.t * b.x[i] + a.x[i] * b.t + a.v * b.tx[i];
  }
  return c;
}

Jet inverse(const Jet& a) {
  const double r = 1 / a.v, r2 = r * r;
  Jet c{r, -r2 * a.t, {}, {}};
  for (std::size_t i = 0; i < n; ++i) {
    c.x[i] = -r2 * a.x[i];
    c.tx[i] = r2 * (2 * r * a.t * a.x[i] - a.tx[i]);
  }
  return c;
}

using Vector = std::array<Jet, 2>;

Jet cross(const Vector& a, const Vector& b) { return a[0] * b[1] - a[1] * b[0]; }
Jet dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1]; }
Vector difference(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1]}; }
Vector scaled(const Jet& s, const Vector& a) { return {s * a[0], s * a[1]}; }

/// Taylor coefficients of a basis function about a parameter, to the third order.
using Taylor = std::array<double, 4>;

/// B-spline basis functions about u in the knot span [knots[k], knots[k + 1]], those of points k - p to k.
/// @from  The NURBS Book, 2nd ed., eq. 2.5 (Cox, de Boor), on Taylor series
std::vector<Taylor> basis_about(double u, std::size_t k, std::size_t p, const std::vector<double>& knots) {
  std::vector<Taylor> basis(p + 1, Taylor{});
  basis[p][0] = 1;
  const auto times = [&](const Taylor& f, double offset, double slope) {
    Taylor g{};
    for (std::size_t i = 0; i < 4; ++i) g[i] = offset * f[i] + (i > 0 ? slope * f[i - 1] : 0);
    return g;
  };
  for (std::size_t degree = 1; degree <= p; ++degree)
    for (std::size_t j = p - degree; j <= p; ++j) {  // the function of point k - p + j
      const std::size_t i = k - p + j;
      Taylor sum{};
      const double rise = knots[i + degree] - knots[i], fall = knots[i + degree + 1] - knots[i + 1];
      if (j > p - degree && rise > 0) sum = times(basis[j], (u - knots[i]) / rise, 1 / rise);
      if (j < p && fall > 0) {
        const Taylor next = times(basis[j + 1], (knots[i + degree + 1] - u) / fall, -1 / fall);
        for (std::size_t m = 0; m < 4; ++m) sum[m] += next[m];
      }
      basis[j] = sum;
    }
  return basis;
}

}  // namespace

/// The curve about a parameter: derivatives of the point up to the third, and of the point and its first two
/// derivatives by the design variables.
struct RayDerivative::Place {
  std::array<std::array<double, 2>, 4> c;
  std::array<std::array<Jet::Row, 2>, 3> moves;

  /// Derivative number `order` of the curve at the parameter `u`, of which only the derivatives count.
  Vector at(const Jet& u, std::size_t order) const {
    Vector point;
    for (std::size_t k = 0; k < 2; ++k) {
      const double d1 = c[order + 1][k], d2 = c[order + 2][k];
      Jet& p = point[k];
      p.v = c[order][k];
      p.t = d1 * u.t;
      for (std::size_t i = 0; i < n; ++i) {
        p.x[i] = d1 * u.x[i] + moves[order][k][i];
        p.tx[i] = d2 * u.t * u.x[i] + d1 * u.tx[i] + moves[order + 1][k][i] * u.t;
      }
    }
    return point;
  }
};

RayDerivative::RayDerivative(const Profile& profile, double source_z_mm, const FieldPlane& plane,
                             int most_interactions, std::size_t group)
    : profile_(profile),
      section_(profile),
      source_z_mm_(source_z_mm),
      plane_(plane),
      most_interactions_(most_interactions),
      group_(group),
      lift_mm_(Tolerance::for_scale(profile.diagonal_mm()).lift_mm) {
  const auto& knots = profile.knots();
  for (auto k = static_cast<std::size_t>(profile.degree()); k < profile.points().size(); ++k)
    if (knots[k] < knots[k + 1]) knot_of_span_.push_back(k);
}

RayDerivative::Place RayDerivative::place_at(const PlanarHit& hit) const {
  return place_at(hit.parameter, hit.span, hit.side);
}

RayDerivative::Place RayDerivative::place_at(double parameter, int span, int side) const {
  const auto p = static_cast<std::size_t>(profile_.degree());
  const std::size_t k = knot_of_span_[static_cast<std::size_t>(span)];
  const std::vector<Taylor> basis = basis_about(parameter, k, p, profile_.knots());
  constexpr double factorial[4] = {1, 1, 2, 6};
  double w[4] = {};
  double sum[4][2] = {};
  for (std::size_t j = 0; j <= p; ++j) {
    const ControlPoint& point = profile_.points()[k - p + j];
    for (std::size_t m = 0; m < 4; ++m) {
      const double value = factorial[m] * basis[j][m] * point.weight;
      w[m] += value;
      sum[m][0] += value * side * point.r_mm;
      sum[m][1] += value * point.z_mm;
    }
  }
  Place place{};
  auto& c = place.c;
  for (std::size_t a = 0; a < 2; ++a) {
    c[0][a] = sum[0][a] / w[0];
    c[1][a] = (sum[1][a] - w[1] * c[0][a]) / w[0];
    c[2][a] = (sum[2][a] - 2 * w[1] * c[1][a] - w[2] * c[0][a]) / w[0];
    c[3][a] = (sum[3][a] - 3 * w[1] * c[2][a] - 3 * w[2] * c[1][a] - w[3] * c[0][a]) / w[0];
  }
  for (std::size_t j = 0; j <= p; ++j) {
    const std::size_t index = k - p + j;
    if (index / 4 != group_) continue;
    const ControlPoint& point = profile_.points()[index];
    const std::size_t first = 3 * (index % 4);
    const double q0 = basis[j][0] / w[0], q1 = (basis[j][1] - w[1] * q0) / w[0];
    const double q2 = (2 * basis[j][2] - 2 * w[1] * q1 - w[2] * q0) / w[0];
    const double by[2] = {static_cast<double>(side), 1.0}, at[2] = {side * point.r_mm, point.z_mm};
    for (std::size_t a = 0; a < 2; ++a) {
      const double off = at[a] - c[0][a];
      place.moves[0][a][first + a] = point.weight * q0 * by[a];
      place.moves[1][a][first + a] = point.weight * q1 * by[a];
      place.moves[2][a][first + a] = point.weight * q2 * by[a];
      place.moves[0][a][first + 2] = q0 * off;
      place.moves[1][a][first + 2] = q1 * off - q0 * c[1][a];
      place.moves[2][a][first + 2] = q2 * off - 2 * q1 * c[1][a] - q0 * c[2][a];
    }
  }
  return place;
}

RayJets::Line RayDerivative::reflect(const RayJets::Line& line, const PlanarHit& hit) const {
  const Place place = place_at(hit);
  const double steep = place.c[1][0] * line.direction[1].v - place.c[1][1] * line.direction[0].v;
  // The distance of the curve's point from the ray's line stays zero: first the first derivatives of the
  // parameter, then, with them, the mixed ones.
  Jet u;
  const Jet first = cross(difference(place.at(u, 0), line.origin), line.direction);
  u.t = -first.t / steep;
  for (std::size_t i = 0; i < n; ++i) u.x[i] = -first.x[i] / steep;
  const Jet second = cross(difference(place.at(u, 0), line.origin), line.direction);
  for (std::size_t i = 0; i < n; ++i) u.tx[i] = -second.tx[i] / steep;
  const Vector tangent = place.at(u, 1);
  const Jet along = 2.0 * dot(line.direction, tangent) * inverse(dot(tangent, tangent));
  return {place.at(u, 0), difference(scaled(along, tangent), line.direction)};
}

RayJets RayDerivative::trace(double theta_rad) const {
  RayJets ray;
  RayJets::Line line;
  line.origin[1].v = source_z_mm_;
  line.direction[0].v = std::sin(theta_rad);
  line.direction[0].t = std::cos(theta_rad);
  line.direction[1].v = std::cos(theta_rad);
  line.direction[1].t = -std::sin(theta_rad);
  for (;;) {
    ray.lines.push_back(line);
    const auto hit = section_.first_hit(
        {line.origin[0].v, line.origin[1].v, line.direction[0].v, line.direction[1].v}, lift_mm_);
    if (!hit) return ray;
    ray.hits.push_back(*hit);
    if (static_cast<int>(ray.hits.size()) > most_interactions_) return ray;
    line = reflect(line, *hit);
  }
}

std::vector<Jet> RayDerivative::landings(const RayJets& ray) const {
  std::vector<Jet> found;
  for (std::size_t k = 1; k < ray.lines.size(); ++k) {
    const auto& [origin, direction] = ray.lines[k];
    const double height = origin[1].v - plane_.z_mm;
    if (!(height * direction[1].v < 0) || (height > 0) != plane_.looks_up) continue;
    if (k < ray.hits.size() && !(-height / direction[1].v <= ray.hits[k].distance_mm)) continue;
    Jet plane;
    plane.v = plane_.z_mm;
    found.push_back(origin[0] + (plane - origin[1]) * inverse(direction[1]) * direction[0]);
  }
  return found;
}

Jet::Row RayDerivative::edge_moves(const RayJets::Line& line, const PlanarHit& edge) const {
  const RationalSpan& span = profile_.spans()[static_cast<std::size_t>(edge.span)];
  // The nearest end of the span, unless the ray grazes; the last ray before an edge lies this near to it.
  constexpr double near = 1e-3;
  const double share = (edge.parameter - span.first) / (span.last - span.first);
  const double at = share < near ? span.first : share > 1 - near ? span.last : edge.parameter;
  const Place place = place_at(at, edge.span, edge.side);
  const Jet off = cross(difference(place.at(Jet{}, 0), line.origin), line.direction);
  Jet::Row moves;
  for (std::size_t i = 0; i < n; ++i) moves[i] = -off.x[i] / off.t;
  return moves;
}

}  // namespace catoptric::sim
