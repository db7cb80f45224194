#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "cad/detail/generatrix_facets.h"
#include "cad/meridian_candidate.h"

namespace catoptric::cad::detail {

/// Newton's method in (t, s) from a facet onto the true surface of revolution; where that fails (a generatrix
/// that runs very unevenly), a search along the strips near by for one that the ray passes through.
template <int Degree>
class FacetRefiner {
 public:
  /// @in  tolerance_mm  distance of ray and surface at which to stop
  FacetRefiner(const meridian::SpanTable& table, const GeneratrixFacets& facets, double chord_mm,
               double tolerance_mm)
      : table_(table),
        facets_(facets),
        vicinity_(8 * chord_mm),
        // Below this the residual is rounding of the part's size; what stays above did not converge.
        enough_(std::max(tolerance_mm, 16 * meridian::Precision<double>::unit_roundoff * table.size)),
        closed_(!table.exact.front().free_lo) {}

  /// @in  t, hit  along the ray, and where on the facet
  /// @out nothing when ray and surface have no common point near by
  std::optional<meridian::Candidate> operator()(const meridian::NearRay& near, double t,
                                                const TriangleHit& hit) const {
    const FacetPoint start = facets_.at(hit);
    Iterate now{t, start.span, start.s};
    measure(near, now);
    constexpr int most_steps = 24;
    for (int i = 0; i < most_steps && !(now.off_squared <= enough_ * enough_); ++i)
      if (!step(near, now)) break;
    if (!(now.off_squared <= enough_ * enough_)) return search(near, t, facets_.places[hit.triangle].strip);
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
    measure_off(near, at);
  }

  void measure_off(const meridian::NearRay& near, Iterate& at) const {
    const double x = near.ox + at.t * near.dx, y = near.oy + at.t * near.dy, z = near.oz + at.t * near.dz;
    const double r = std::sqrt(x * x + y * y);
    at.outward = r > 0 ? (x * near.dx + y * near.dy) / r : std::sqrt(near.dx * near.dx + near.dy * near.dy);
    at.off_r = r - at.point.r;
    at.off_z = z - at.point.z;
    at.off_squared = at.off_r * at.off_r + at.off_z * at.off_z;
  }

  /// One step, shortened until it comes nearer.
  bool step(const meridian::NearRay& near, Iterate& now) const {
    const double determinant = near.dz * now.point.dr - now.outward * now.point.dz;
    if (determinant == 0) return false;
    double along_t = (now.off_r * now.point.dz - now.off_z * now.point.dr) / determinant;
    double along_s = (near.dz * now.off_r - now.outward * now.off_z) / determinant;
    if (!std::isfinite(along_t) || !std::isfinite(along_s)) return false;
    constexpr double finest = 4 * meridian::Precision<double>::unit_roundoff;
    if (std::abs(along_s) <= finest * now.s) {  // the parameter cannot say where; the point can
      now.t += along_t;
      now.point.r += now.point.dr * along_s;
      now.point.z += now.point.dz * along_s;
      measure_off(near, now);
      return now.off_squared <= enough_ * enough_;
    }
    constexpr int most_shortenings = 6;
    for (int i = 0; i < most_shortenings; ++i) {
      Iterate next = now;
      next.t += along_t;
      move(next, along_s);
      measure(near, next);
      if (next.off_squared < now.off_squared) {
        now = next;
        return true;
      }
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

  /// The common point nearest to t on the strips within `vicinity_` of the given one.
  std::optional<meridian::Candidate> search(const meridian::NearRay& near, double t,
                                            std::uint32_t strip) const {
    const Ray ray{Vector3(near.ox, near.oy, near.oz), Vector3(near.dx, near.dy, near.dz)};
    const meridian::AxisLine<double> line(ray, near, table_);
    if (std::abs(line.dz) <= meridian::horizontal_slope * line.h) return std::nullopt;
    std::optional<meridian::Candidate> best = on_strip(near, line, strip);
    for (const int direction : {-1, 1}) {
      double gone = 0;
      for (auto next = static_cast<std::ptrdiff_t>(strip); gone <= vicinity_;) {
        next = neighbour(next, direction);
        if (next < 0 || next == static_cast<std::ptrdiff_t>(strip)) break;
        const auto found = on_strip(near, line, static_cast<std::size_t>(next));
        if (found && (!best || std::abs(found->t - t) < std::abs(best->t - t))) best = found;
        gone += facets_.strips[static_cast<std::size_t>(next)].length_mm;
      }
    }
    return best;
  }

  /// @out  -1 beyond an end
  std::ptrdiff_t neighbour(std::ptrdiff_t strip, int direction) const {
    const auto count = static_cast<std::ptrdiff_t>(facets_.strips.size());
    const std::ptrdiff_t next = strip + direction;
    if (next >= 0 && next < count) return next;
    return closed_ ? (next + count) % count : -1;
  }

  std::optional<meridian::Candidate> on_strip(const meridian::NearRay& near,
                                              const meridian::AxisLine<double>& line,
                                              std::size_t number) const {
    const FacetStrip& strip = facets_.strips[number];
    if (strip.beyond) return std::nullopt;
    const meridian::SpanForm& span = table_.spans[static_cast<std::size_t>(strip.span)];
    const auto at = [&span](double s) { return meridian::evaluate<Degree>(span, s); };
    const meridian::CrossingResidual<double> residual{line};
    const auto low = residual(at(strip.s0)), high = residual(at(strip.s1));
    if ((low.value < 0) == (high.value < 0)) return std::nullopt;
    const auto root = meridian::refine<double>(residual, at, strip.s0, strip.s1, low.value < 0 ? -1 : 1,
                                               0.5 * (strip.s0 + strip.s1));
    const double along = meridian::distance_along(line, root.point.r, root.point.z);
    return meridian::make_candidate(near, along, root.s, root.point.r, root.point.z, strip.span);
  }

  const meridian::SpanTable& table_;
  const GeneratrixFacets& facets_;
  double vicinity_;  ///< of a facet, mm along the generatrix, in which its hit is sought
  double enough_;
  bool closed_;
};

}  // namespace catoptric::cad::detail
