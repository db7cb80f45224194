#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "base/planar_hits.h"
#include "sim/material.h"
#include "sim/tube_trace.h"

namespace catoptric::sim {

/// Design variables are taken so many at a time: r, z and weight of four control points.
inline constexpr std::size_t variables_at_once = 12;

/// A number with its derivatives by the emission angle, by each of some design variables, and by both.
struct Jet {
  using Row = std::array<double, variables_at_once>;
  double v = 0, t = 0;
  Row x{}, tx{};
};

/// A ray's meetings with the mirror and its line before each of them; the last line has none unless the most
/// interactions are exceeded.
struct RayJets {
  struct Line {
    std::array<Jet, 2> origin, direction;
  };
  std::vector<Line> lines;
  std::vector<PlanarHit> hits;
};

/// Follows rays of a mirror that only reflects, with derivatives by control points [4 group, 4 group + 4).
/// @in    as TubeTracer; no transmittance
/// @error exact but for rounding: the hit's parameter by implicit differentiation, everything else by the
///        chain rule
/// @from  The NURBS Book, 2nd ed., eq. 4.2 and ch. 2 for the rational basis and its derivatives
class RayDerivative {
 public:
  RayDerivative(const Profile& profile, double source_z_mm, const FieldPlane& plane, int most_interactions,
                std::size_t group);

  /// The ray with all its meetings.
  RayJets trace(double theta_rad) const;

  /// Where its lines meet the plane, in order, as TubeTracer has them.
  std::vector<Jet> landings(const RayJets& ray) const;

  /// How the emission angle changes at which a line passes through the end of the generatrix, a knot, or the
  /// outline that `edge` lies on or next to.
  /// @in    line: the ray's before that meeting
  Jet::Row edge_moves(const RayJets::Line& line, const PlanarHit& edge) const;

 private:
  struct Place;
  Place place_at(const PlanarHit& hit) const;
  Place place_at(double parameter, int span, int side) const;
  RayJets::Line reflect(const RayJets::Line& line, const PlanarHit& hit) const;

  const Profile& profile_;
  PlanarMirror section_;
  double source_z_mm_;
  FieldPlane plane_;
  int most_interactions_;
  std::size_t group_;
  double lift_mm_;
  std::vector<std::size_t> knot_of_span_;
};

}  // namespace catoptric::sim
