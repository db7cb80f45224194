#pragma once

#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <optional>
#include <string>

#include "cad/shape.h"

namespace catoptric::cad::detail {

/// Outcome of comparing what was read back with what was written.
struct Comparison {
  std::optional<std::string> loss;  ///< the first thing that differs, in words
  double largest_deviation_mm = 0;
};

/// What a format can hold of a shape.
enum class Keeps {
  everything,
  faces,  ///< neither solids nor the difference between a cone and a surface of revolution (IGES faces)
};

/// Whether `reread` still is `written`, which was made from `profile`: one face on a surface of revolution
/// about z whose generatrix has the profile's degree, knots, poles and weights (weights up to a common
/// factor, since exchange formats drop equal ones), the same kinds of surfaces, solids, bounding box, area
/// and volume.
/// @error lengths within Tolerance::exchange_mm; weights and knots relative 1e-12
Comparison compare(const TopoDS_Shape& reread, const TopoDS_Shape& written, const Profile& profile,
                   Keeps keeps = Keeps::everything);

/// The face of a part that is the optical surface, by its generatrix as compare() takes it.
/// @fails CadError when there is none
TopoDS_Face optical_face_of(const TopoDS_Shape& part, const Profile& profile);

}  // namespace catoptric::cad::detail
