#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "cad/detail/generatrix_facets.h"
#include "cad/meridian_candidate.h"

namespace catoptric::cad::detail {

/// Newton's method in (t, s) from a facet onto the true surface of revolution.
template <int Degree>
class FacetRefiner {
 public:
  /// @in  tolerance_mm  distance of ray and surface at which to stop
  FacetRefiner(const meridian::SpanTable& table, double tolerance_mm)
      : table_(table),
        // Below this the residual is rounding of the part's size; what stays above did not converge.
        enough_(std::max(tolerance_mm, 16 * meridian::Precision<double>::unit_roundoff * table.size)),
        closed_(!table.exact.front().free_lo) {}

  /// @in  t, start  along the ray and on the generatrix, at the facet
  /// @out nothing when Newton's method finds no common point near by
  std::optional<meridian::Candidate> operator()(const meridian::NearRay& near, double t,
                                                const FacetPoint& start) const {
    Iterate now{t, start.span, start.s};
    measure(near, now);
    constexpr int most_steps = 24;
    for (int i = 0; i < most_steps && !(now.off_squared <= enough_ * enough_); ++i) {
      Iterate next = now;
      if (!step(near, now, next)) return std::nullopt;
      now = next;
    }
    if (!(now.off_squared <= enough_ * enough_)) return std::nullopt;
    return meridian::make_candidate(near, now.t, now.s, now.point.r, now.point.z, now.span);
  }

 private:
  struct Iterate {
    double t;
    int span;
    double s;
    meridian::CurvePoint<double> point{};
    double outward = 0;           ///< speed of the ray away from the axis
    double off_r = 0, off_z = 0;  ///< ray minus surface
    double off_squared = 0;
  };

  void measure(const meridian::NearRay& near, Iterate& at) const {
    at.point = meridian::evaluate<Degree>(table_.spans[static_cast<std::size_t>(at.span)], at.s);
    const double x = near.ox + at.t * near.dx, y = near.oy + at.t * near.dy, z = near.oz + at.t * near.dz;
    const double r = std::sqrt(x * x + y * y);
    at.outward = r > 0 ? (x * near.dx + y * near.dy) / r : std::sqrt(near.dx * near.dx + near.dy * near.dy);
    at.off_r = r - at.point.r;
    at.off_z = z - at.point.z;
    at.off_squared = at.off_r * at.off_r + at.off_z * at.off_z;
  }

  /// One step, shortened until it comes nearer.
  bool step(const meridian::NearRay& near, const Iterate& now, Iterate& next) const {
    const double determinant = near.dz * now.point.dr - now.outward * now.point.dz;
    double along_t = (now.off_r * now.point.dz - now.off_z * now.point.dr) / determinant;
    double along_s = (near.dz * now.off_r - now.outward * now.off_z) / determinant;
    if (!std::isfinite(along_t) || !std::isfinite(along_s)) return false;
    constexpr int most_shortenings = 6;
    for (int i = 0; i < most_shortenings; ++i) {
      next = now;
      next.t += along_t;
      move(next, along_s);
      measure(near, next);
      if (next.off_squared < now.off_squared) return true;
      constexpr double shorter = 0.25;
      along_t *= shorter;
      along_s *= shorter;
    }
    return false;
  }

  /// Moves along the generatrix, from span to span, not beyond its ends.
  void move(Iterate& at, double along_s) const {
    const int last = static_cast<int>(table_.spans.size()) - 1;
    double s = at.s + along_s;
    for (int crossed = 0; crossed <= last && (s < 0 || s > 1); ++crossed) {
      const bool up = s > 1;
      int next = at.span + (up ? 1 : -1);
      if (next < 0 || next > last) {
        if (!closed_) break;
        next = up ? 0 : last;
      }
      const double width = table_.spans[static_cast<std::size_t>(at.span)].width;
      const double past = (up ? s - 1 : -s) * width / table_.spans[static_cast<std::size_t>(next)].width;
      s = up ? past : 1 - past;
      at.span = next;
    }
    at.s = std::clamp(s, 0.0, 1.0);
  }

  const meridian::SpanTable& table_;
  double enough_;
  bool closed_;
};

}  // namespace catoptric::cad::detail
