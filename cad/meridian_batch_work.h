#pragma once

#include <vector>

#include "cad/meridian_lanes.h"
#include "cad/meridian_line.h"
#include "cad/meridian_pieces.h"

namespace catoptric::cad::meridian {

/// Four rays side by side.
struct RayGroup {
  NearRays<Lanes> near;
  AxisLine<Lanes> line;
  Culler<Lanes> culler;
  CrossingFactors<Lanes> factors;
  Mask open;   ///< rays to be answered here
  Mask alone;  ///< rays left to be done alone
};

/// A piece that a ray certainly crosses once.
struct CrossingJob {
  double start, sign_lo;  ///< where to look first; sign of F at the piece's lower end
  std::size_t piece, ray;
};

/// The nearest hits so far.
struct NearestHits {
  std::vector<double> t, s, r, z;
  std::vector<const SpanForm*> span;
};

}  // namespace catoptric::cad::meridian
