#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/profile.h"
#include "cad/export.h"

namespace catoptric::cad::detail {

/// One curve of a drawing in the plane, x = r and y = z.
struct DrawnCurve {
  enum class Kind { line, arc, spline, polyline };
  Kind kind;
  std::string layer;
  std::vector<Vector2> points;         ///< ends, control points or vertices; of an arc its centre
  int degree = 0;                      ///< of a spline, as the three that follow
  std::vector<double> weights = {};    ///< empty: all alike
  std::vector<double> knots = {};      ///< flat
  double radius = 0;                   ///< of an arc, as the two that follow
  double first_deg = 0, last_deg = 0;  ///< counter-clockwise from x
  bool operator==(const DrawnCurve&) const = default;
};

/// A drawing with the unit of its numbers.
struct Drawing {
  LengthUnit unit = LengthUnit::millimetre;
  std::vector<DrawnCurve> curves;
  double chord_mm = 0;  ///< how far a polyline may be from its curve; 0: all are exact
};

/// The half section that a spinner or turner works to: the generatrix on layer OPTICAL, what bounds the wall
/// on BACK, EDGE and FLANGE, and the axis on AXIS, a twentieth of the part beyond it.
/// @in    wall: nothing for the optical surface alone
/// @fails CadError when the wall cannot be built
/// @error lengths as the profile has them, to one rounding in units other than mm; polylines within
///        Drawing::chord_mm, 1e-6 of the part; the back as wall_tolerance_mm says
Drawing section_drawing(const Profile& profile, const std::optional<Wall>& wall, LengthUnit unit,
                        DxfCurves curves);

/// @fails IoError when the file cannot be written
void write_dxf(const Drawing& drawing, const std::filesystem::path& path, const std::string& title);

/// @fails CadError when it cannot be read
Drawing read_dxf(const std::filesystem::path& path);

/// What of a drawing is not in another one, in words, or nothing: numbers are compared bit for bit.
std::optional<std::string> difference(const Drawing& written, const Drawing& reread);

}  // namespace catoptric::cad::detail
