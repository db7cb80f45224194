#pragma once

#include <cstdint>
#include <vector>

#include "cad/detail/triangle_scene.h"
#include "cad/meridian_spans.h"

namespace catoptric::cad::detail {

/// The facets between two neighbouring rings of vertices: a stretch of one span, s0 to s1 of its parameter.
struct FacetStrip {
  int span;
  double s0, s1;
  double length_mm;
  bool beyond;   ///< drawn on past an end of the generatrix, so that rays to the very rim meet a facet
  bool crowded;  ///< another part of the generatrix is so near that the order of facets is not that of hits
};

/// A triangle's place: its strip, and which of its corners lie on the ring of s1.
struct FacetPlace {
  std::uint32_t strip;
  std::array<std::uint8_t, 3> on_outer;
};

/// Where a facet was met, in the generatrix's terms.
struct FacetPoint {
  int span;
  double s;
};

/// A revolved generatrix as triangles: rings of vertices on it, as many and as wide apart as the chord error
/// asks, straddling the surface in azimuth so that half as many do. No triangle is degenerate: a ring on the
/// axis is one vertex.
struct GeneratrixFacets {
  /// @in    chord_mm  greatest distance between facets and surface
  /// @fails InputError when that takes more than `most_triangles`
  GeneratrixFacets(const meridian::SpanTable& table, double chord_mm);

  FacetPoint at(const TriangleHit& hit) const {
    const FacetPlace& place = places[hit.triangle];
    const FacetStrip& strip = strips[place.strip];
    const double rest = 1 - hit.share1 - hit.share2;
    const double share =
        place.on_outer[0] * rest + place.on_outer[1] * hit.share1 + place.on_outer[2] * hit.share2;
    return {strip.span, (1 - share) * strip.s0 + share * strip.s1};
  }

  double scale;  ///< mesh units per mm, a power of two
  std::vector<FacetStrip> strips;
  std::vector<FacetPlace> places;  ///< of each triangle
  TriangleMesh mesh;               ///< z from the part's centre
};

}  // namespace catoptric::cad::detail
