#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/ray.h"

namespace catoptric::report {

using Polyline = std::vector<Vector3>;

/// A surface that is lit, by its border.
struct ViewedField {
  std::vector<Polyline> outlines;
  Vector3 center;
  bool flat;  ///< bounded by its first outline, convex about the centre
};

struct ViewedSource {
  std::string kind;  ///< "disc", "rectangle", "cylinder"; anything else is a ball
  Vector3 position, axis, along;
  double radius = 0, length = 0, width = 0, height = 0;
};

/// Mirror, source, fields and some rays in space, all in one unit of length.
struct View3d {
  std::vector<Vector2> generatrix;  ///< r, z along the curve; revolved about z
  std::vector<ViewedSource> sources;
  std::vector<ViewedField> fields;
  std::vector<Polyline> objects;  ///< lines on what stands about the mirror
  std::vector<Polyline> rays;     ///< each from the source on
  Vector3 center;                 ///< of what is looked at
  double radius = 1;              ///< about it, greater than 0
  bool from_above = true;         ///< where the eye stands
  std::string caption;
};

/// The view as JSON, which view_script.h reads: five digits, enough for any screen. Fit to stand in a page's
/// script element whatever it holds.
std::string view_json(const View3d& view);

/// Cuts a ray's way off where it leaves the ball of what is looked at for good.
Polyline within(const Polyline& path, const Vector3& center, double radius);

/// A script's or JSON's text that cannot end or hide the element it stands in.
/// @from  HTML Living Standard 4.12.1.3: no "<!--", "<script" or "</script" inside
std::string inside_script(std::string_view text);

}  // namespace catoptric::report
