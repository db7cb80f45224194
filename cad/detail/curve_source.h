#pragma once

#include <Geom_BSplineCurve.hxx>
#include <TopoDS_Shape.hxx>
#include <filesystem>
#include <gp_Ax1.hxx>
#include <optional>
#include <string>
#include <vector>

#include "base/errors.h"

namespace catoptric::cad::detail {

/// How far a file's numbers may be off, over the size of the curve: most IGES writers keep six decimals.
inline constexpr double import_rel = 1e-6;

/// A curve of a file as one B-spline in space, mm.
struct SourceCurve {
  std::string description;  ///< "B-spline curve (IGES 126 in D1), degree 2, 3 control points"
  Handle(Geom_BSplineCurve) curve;
  std::vector<std::string> notes;  ///< conversions
  std::optional<gp_Ax1> axis;      ///< its own, when it is the meridian of a face
  bool is_line = false;
};

/// A curve that could not be converted, and why.
struct Refusal {
  std::string name;
  ErrorParts parts;
  std::string text() const { return name + ": " + parts.what + (parts.why.empty() ? "" : ": " + parts.why); }
};

/// What a file offers.
struct CurveSource {
  std::string unit;                 ///< in words
  std::vector<SourceCurve> curves;  ///< free curves, or else meridians of faces
  std::vector<gp_Ax1> face_axes;    ///< axes of all faces of revolution
  std::vector<Refusal> refused;     ///< what could not be converted

  /// Takes the axes of the faces, and where there is no free curve, their meridians.
  void add_meridians(CurveSource from_faces) {
    face_axes = std::move(from_faces.face_axes);
    if (!curves.empty()) return;
    curves = std::move(from_faces.curves);
    refused.insert(refused.end(), from_faces.refused.begin(), from_faces.refused.end());
  }
};

/// @fails CadError when the file is broken
CurveSource read_iges_curves(const std::filesystem::path& file);
CurveSource read_step_curves(const std::filesystem::path& file);

/// A stretch of a curve as a B-spline.
struct CurvePiece {
  Handle(Geom_BSplineCurve) spline;
  std::string kind;  ///< "line", "arc", "B-spline", ...
  double deviation_mm = 0;
};

/// The edges of an edge, wire or compound, in order, as B-splines of at most degree 9.
/// @fails CadError when an edge has no curve or cannot be approximated
std::vector<CurvePiece> pieces_of(const TopoDS_Shape& edges);

/// Sorts loose pieces into chains: pieces whose ends meet two at a time, in order. STEP writers (OCCT's too)
/// take wires apart. Where three or more ends meet nothing is joined.
std::vector<std::vector<CurvePiece>> chains_of(std::vector<CurvePiece> pieces);

/// One B-spline from pieces that follow each other, each either way round.
/// @fails CadError at a gap
SourceCurve joined_curve(const std::vector<CurvePiece>& pieces);

/// Meridians of the shape's faces of revolution, and their axes.
void add_faces_of_revolution(const TopoDS_Shape& shape, CurveSource& source);

}  // namespace catoptric::cad::detail
