#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "base/profile.h"

namespace catoptric {

/// A ray that stays in a meridian plane. x is the signed radius: the mirror's section is the generatrix on
/// x >= 0 and its mirror image on x <= 0.
struct PlanarRay {
  double x_mm, z_mm;
  double dx, dz;  ///< unit length
};

/// Where a planar ray meets the section, with what a ray tube needs of the curve there.
struct PlanarHit {
  double distance_mm;  ///< along the ray, from its origin
  double x_mm, z_mm;   ///< on the curve
  double tx, tz;       ///< unit tangent in the plane, along rising parameter
  double curvature;    ///< of the section, 1/mm, positive when the tangent turns counter-clockwise (x to z)
  double parameter;    ///< of the generatrix, in the profile's knot range
  int span;            ///< index into Profile::spans()
  int side;            ///< +1 on the generatrix, -1 on its image
};

/// Many planar rays, and where each first meets the section: number by number in arrays of one length.
struct PlanarRays {
  std::span<const double> x_mm, z_mm, dx, dz;
};
struct PlanarFirstHits {
  std::span<double> distance_mm;  ///< infinite where the ray meets nothing; the rest then means nothing
  std::span<double> x_mm, z_mm;   ///< on the curve
  std::span<double> tx, tz;       ///< unit tangent in the plane
};

/// The mirror's section by a meridian plane, ready for rays. Immutable and safe to share.
///
/// Along a span, the distance from the ray's line times the weight is a Bernstein polynomial of the span's
/// own degree p (in space it is 2p). Up to p = 2 its roots are closed forms chosen by the signs at the ends;
/// above, they are isolated by the signs of the coefficients, which count only beyond their rounding, and
/// refined by Newton's method inside the bracket. Values at shared ends are the same numbers in both
/// neighbours, so no root is lost or found twice at a knot or at the vertex; a free end belongs to the
/// mirror.
/// @error hits within some ten roundings of the part's size; a line that touches the curve to within rounding
///        counts as one touch
/// @from  Farouki & Rajan 1987; Lane & Riesenfeld 1981
class PlanarMirror {
 public:
  explicit PlanarMirror(const Profile& profile);

  /// The nearest hit farther along the ray than `beyond_mm` (>= 0). Allocates nothing.
  /// @cost O(spans degree) and a few dozen operations per hit
  std::optional<PlanarHit> first_hit(const PlanarRay& ray, double beyond_mm) const;

  /// The nearest hits of many rays, several rays at a time where a mirror of degree 2 answers them by one
  /// certain change of sign; all others as `first_hit` does. The hits are those of `first_hit` but for the
  /// tangents' last digits.
  /// @cost  some 5 ns a ray and span where several go at a time
  void first_hits(const PlanarRays& rays, double beyond_mm, const PlanarFirstHits& hits) const;

  /// All hits farther than `beyond_mm`, nearest first, each once.
  void all_hits(const PlanarRay& ray, double beyond_mm, std::vector<PlanarHit>& hits) const;

  /// The part's largest extent, from which tolerances follow.
  double diagonal_mm() const { return diagonal_mm_; }

 private:
  static constexpr std::size_t most_poles = 10;
  /// A span in homogeneous coordinates, z from the part's centre.
  struct Span {
    std::array<double, most_poles> rw, zw, w;
    double first, width;
    bool free_lo, free_hi;  ///< whether the section ends there (a vertex on the axis is no end)
  };
  struct Line;
  struct Block;  ///< rays that go through the spans together
  void meet_spans(double beyond_mm, Block& block) const;
  struct Root {
    double distance_mm, s;
    int span, side;
  };
  template <typename Take>
  void for_each_root(const Line& line, const Take& take) const;
  PlanarHit hit_at(const Root& root) const;

  int degree_;
  double centre_z_mm_, size_mm_, diagonal_mm_;
  std::vector<Span> spans_;
  std::vector<RationalSpan> exact_;
};

}  // namespace catoptric
