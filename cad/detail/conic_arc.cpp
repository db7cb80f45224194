#include "cad/detail/conic_arc.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "base/float_traps.h"
#include "base/units.h"

namespace catoptric::cad::detail {
namespace {

constexpr double end_rel = 1e-6;        // six-digit IGES writers
constexpr double parabola_rel = 1e-10;  // discriminant over the square of the coefficients: their rounding,
                                        // with room for writers that compute them

[[noreturn]] void refuse(std::string why) {
  throw CadError(
      {"a conic arc (IGES 104) makes no curve", "", std::move(why), "export it as a B-spline (IGES 126)"});
}

/// The conic as a symmetric form: its value at p is p~ M p~ with p~ = (x, y, 1).
using Form = Eigen::Matrix3d;

Form form_of(const std::array<double, 6>& c) {
  Form m;
  m << c[0], c[1] / 2, c[3] / 2, c[1] / 2, c[2], c[4] / 2, c[3] / 2, c[4] / 2, c[5];
  return m;
}

Vector3 lifted(const Vector2& p) { return {p.x(), p.y(), 1}; }
Vector2 gradient(const Form& m, const Vector2& p) { return 2 * (m * lifted(p)).head<2>(); }

void check_on_conic(const Form& m, const Vector2& p, double size) {
  const double value = lifted(p).dot(m * lifted(p)), slope = gradient(m, p).norm();
  if (!(std::abs(value) <= end_rel * size * slope))
    refuse(fmt::format("its end ({}, {}) does not lie on the conic", p.x(), p.y()));
}

/// In the frame centre + cos a + sin b of conjugate radii the ellipse is a circle, turned counterclockwise.
ConicArc ellipse(const Form& m, const Vector2& start, const Vector2& end) {
  Eigen::Matrix2d q = m.topLeftCorner<2, 2>();
  const Vector2 centre = q.colPivHouseholderQr().solve(-m.topRightCorner<2, 1>());
  if (q.trace() < 0) q = -q;
  const Vector2 a = start - centre, qa = q * a;
  const Vector2 b = Vector2(-qa.y(), qa.x()) / std::sqrt(q.determinant());
  const double square = a.dot(qa);
  if (!(square > 0 && square < HUGE_VAL) || !b.allFinite()) refuse("its ellipse has no points");
  const Vector2 last = q * (end - centre);
  double angle = std::atan2(b.dot(last), a.dot(last));
  if (angle < 0) angle += 2 * pi;
  if ((end - start).norm() <= end_rel * a.norm()) angle = 2 * pi;
  if (!std::isfinite(angle)) refuse("its end lies out of the range of numbers");
  const int pieces = std::max(1, static_cast<int>(std::ceil(angle / (pi / 2) - end_rel)));
  const double half = angle / pieces / 2;
  const auto at = [&](double t, double stretch) -> Vector2 {
    return centre + stretch * (std::cos(t) * a + std::sin(t) * b);
  };
  ConicArc arc{"ellipse", {start}, {1}, {0, 0, 0}};
  for (int i = 0; i < pieces; ++i) {
    arc.points.push_back(at((2 * i + 1) * half, 1 / std::cos(half)));
    arc.weights.push_back(std::cos(half));
    arc.points.push_back(i + 1 == pieces ? end : at((2 * i + 2) * half, 1));
    arc.weights.push_back(1);
    arc.knots.insert(arc.knots.end(), 2, i + 1.0);
  }
  arc.knots.push_back(pieces);
  return arc;
}

/// Middle control point where the end tangents meet; its weight from M(P0 + 2 w P1 + P2) = 0, in which M
/// pairs P1 with neither end.
ConicArc open_conic(const Form& m, bool is_parabola, const Vector2& start, const Vector2& end) {
  Eigen::Matrix2d tangents;
  tangents.row(0) = gradient(m, start).transpose();
  tangents.row(1) = gradient(m, end).transpose();
  const Vector2 right(gradient(m, start).dot(start), gradient(m, end).dot(end));
  const Vector2 middle = tangents.colPivHouseholderQr().solve(right);
  if (!middle.allFinite() ||
      std::abs(tangents.determinant()) <= 1e-12 * tangents.row(0).norm() * tangents.row(1).norm())
    refuse("its ends have parallel tangents");  // 1e-12: the tangents meet a million arcs away
  double weight = 1;
  if (!is_parabola) {
    const double square = -lifted(start).dot(m * lifted(end)) / (2 * lifted(middle).dot(m * lifted(middle)));
    if (!(square > 0)) refuse("its ends lie on two branches of a hyperbola");
    weight = std::sqrt(square);
  }
  return {is_parabola ? "parabola" : "hyperbola", {start, middle, end}, {1, weight, 1}, {0, 0, 0, 1, 1, 1}};
}

}  // namespace

ConicArc conic_arc(const std::array<double, 6>& coefficients, const Vector2& start, const Vector2& end) {
  const UntrappedFloats untrapped;  // a file's numbers may overflow; what is then not finite is refused
  const Form m = form_of(coefficients);
  if (!m.allFinite() || !start.allFinite() || !end.allFinite()) refuse("a number of it is not finite");
  const double discriminant = -4 * m.topLeftCorner<2, 2>().determinant();
  const double squares = m.topLeftCorner<2, 2>().squaredNorm();
  if (!(squares > 0)) refuse("its conic is a straight line");
  const bool is_parabola = std::abs(discriminant) <= parabola_rel * squares;
  const bool is_ellipse = !is_parabola && discriminant < 0;
  const double size = (end - start).norm();
  if (!is_ellipse && !(size > 0)) refuse("it has no length");
  const ConicArc arc = is_ellipse ? ellipse(m, start, end) : open_conic(m, is_parabola, start, end);
  const double reach = is_ellipse ? (arc.points[1] - start).norm() : size;
  check_on_conic(m, start, reach);
  check_on_conic(m, end, reach);
  for (std::size_t i = 0; i < arc.points.size(); ++i)
    if (!(arc.points[i].allFinite() && arc.weights[i] > 0 && std::isfinite(arc.weights[i])))
      refuse("it leaves the range of numbers");
  return arc;
}

}  // namespace catoptric::cad::detail
