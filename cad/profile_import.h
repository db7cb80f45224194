#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/profile.h"

namespace catoptric::cad {

/// An axis of revolution in a file's coordinates, in mm.
struct Axis {
  Vector3 origin_mm;
  Vector3 direction;  ///< any length but zero
};

struct ImportOptions {
  std::optional<std::size_t> candidate;  ///< which curve, as numbered in ImportedProfile::candidates
  std::optional<Axis> axis;              ///< nothing: found in the file
  std::optional<std::chrono::milliseconds> time_limit;  ///< nothing: 20 s, and 2 s more for each MiB
};

/// A generatrix found in a file.
struct ImportedProfile {
  Profile profile;
  std::vector<std::string> notes;       ///< what was found and converted, in words
  std::vector<std::string> candidates;  ///< all curves that could have been meant; the index is the selector
};

/// Reads a generatrix from an IGES or STEP file (told apart by their content).
///
/// Candidates are the file's free curves: IGES 100, 102, 104, 106, 110, 112, 126, 130, and STEP wires and
/// edges outside faces (edges that meet end to end are one curve). A lone line beside another curve is its
/// axis, not a candidate. A file without free curves offers the meridians of its faces of revolution (surface
/// of revolution, cylinder, cone, sphere, torus), equal ones once.
///
/// Axis, first that applies: options.axis; a face's own axis; the lone line; the axis of a face of revolution
/// in the file, if all have the same; the coordinate axis that lies in a plane with the curve and is
/// nearest to an end of it (z before y before x when equally near).
///
/// r is the distance from the axis. z runs in the axis' own direction from the file's origin dropped on the
/// axis; with options.axis from its origin. The curve runs from its smaller to its greater r.
///
/// @in    file in any unit of length; result in mm
/// @fails CadError when there is no file, it is neither IGES nor STEP or broken, there is no curve, more than
///        one and no choice, a gap in a composite curve, a curve that is not in a plane with the axis or
///        crosses it, a degree or weight that Profile does not take
/// @error B-splines keep their control points, weights and knots (a few roundings of the rotation); arcs and
///        conics become rational B-splines to rounding; degrees above 9 and curves OCCT has no B-spline of
///        are approximated within 1e-6 of their size, and a note says by how much. The same 1e-6 (what
///        six-digit IGES writers keep) goes for planarity, gaps and ends on the axis
/// @cost  some 10 ms; the file is read in a child process, since a broken one can kill or hang OCCT
ImportedProfile import_profile(const std::filesystem::path& file, const ImportOptions& options = {});

}  // namespace catoptric::cad
