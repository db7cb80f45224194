#pragma once

#include <cmath>

#include "sim/near_field.h"

namespace catoptric::sim {

/// The part of the near field's plane where every photon is recorded: a disc or a rectangle about its centre,
/// in plane coordinates. For an invisible register the patch and a margin round it, so that an estimate at
/// the edge finds its neighbours outside; for a real patch the patch alone, since nothing lands beyond it. A
/// cylinder has no edge on its way round: photons are recorded there once more beyond the seam. Of facets
/// all.
struct RecordedArea {
  NearField::Shape shape = NearField::Shape::disc;
  double half_width_mm = 0, half_height_mm = 0;

  static RecordedArea about(const NearField& field, double margin_mm) {
    const double extra = field.material() ? 0.0 : margin_mm;
    if (field.shape() == NearField::Shape::cylinder)
      return {NearField::Shape::rectangle, field.half_width_mm() + margin_mm, field.half_height_mm() + extra};
    return {field.shape(), field.half_width_mm() + extra, field.half_height_mm() + extra};
  }

  bool contains(const Vector2& plane_mm) const {
    if (shape == NearField::Shape::facets) return true;
    if (shape == NearField::Shape::disc) return plane_mm.squaredNorm() <= half_width_mm * half_width_mm;
    return std::abs(plane_mm.x()) <= half_width_mm && std::abs(plane_mm.y()) <= half_height_mm;
  }
};

}  // namespace catoptric::sim
