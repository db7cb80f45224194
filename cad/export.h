#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "base/profile.h"
#include "base/units.h"
#include "cad/shape.h"

namespace catoptric::cad {

/// STEP, IGES and BREP keep the exact surface; STL and GLB are meshes for viewing and printing; DXF is the
/// half section in the plane, for spinning and turning.
enum class FileFormat { step, iges, brep, stl, glb, dxf };

/// The format that a file name's extension asks for: .step .stp, .igs .iges, .brep .brp, .stl, .glb, .dxf.
/// @fails CadError for any other extension
FileFormat format_of(const std::filesystem::path& path);

/// "STEP", "IGES", ...
std::string_view name_of(FileFormat format);

enum class StepSchema { ap203, ap214, ap242 };

/// How IGES holds a face: trimmed surface (144), or boundary representation (186 with 510, 508, 504, 502).
/// Some measuring programs read one and not the other. As faces a walled mirror is the set of its faces, not
/// a solid.
enum class IgesMode { faces, brep };

/// How a DXF holds curves. Some readers ignore the weights of a rational spline, and show another mirror, or
/// leave out splines above degree 3, without a word; a polyline is read by all. Automatic: splines where all
/// read them.
enum class DxfCurves { automatic, splines, polylines };

/// What the part is made of.
struct PartMaterial {
  std::string name;  ///< printable ASCII; empty: not said
  std::optional<double> density_kg_per_m3;
};

struct ExportOptions {
  LengthUnit unit =
      LengthUnit::millimetre;  ///< of the numbers in the file. BREP is always in mm; GLB in metres
  StepSchema schema = StepSchema::ap214;
  IgesMode iges_mode = IgesMode::faces;
  DxfCurves dxf_curves = DxfCurves::automatic;
  PartMaterial material;              ///< of a walled mirror, in STEP of AP242
  std::optional<Wall> wall;           ///< nothing: the open optical surface
  std::string product = "reflector";  ///< printable ASCII, like the two that follow
  std::string author;                 ///< empty unless said; never the login name
  std::string organization;
  /// "2026-01-31T12:00:00". Empty: the environment's SOURCE_DATE_EPOCH, or else 1970-01-01T00:00:00, so that
  /// the same mirror gives the same bytes whenever it is written.
  std::string time_stamp;
  double chord_tolerance_rel =
      1e-4;  ///< meshes only: how far a facet may be from the surface, over the extent
};

/// What was written, as the reader saw it that read it back.
struct ExportReport {
  FileFormat format;
  ShapeFigures figures;             ///< of the shape that was written
  double largest_deviation_mm = 0;  ///< of poles and bounding box, written against read back (exact formats)
  int triangle_count = 0;           ///< meshes only
  double chord_mm = 0;  ///< meshes, and polylines of a DXF: how far they may be from the part; 0: not at all
};

/// Writes the mirror to a file whose extension says the format, whole or not at all. The optical axis is the
/// file's z axis. Exact files are read back with a fresh reader and compared: generatrix (degree, knots,
/// poles, weights), axis, kinds of surfaces, bounding box, area, volume; in STEP of AP242 names, colours and
/// material too; a DXF number by number.
/// @in    options.chord_tolerance_rel in [1e-6, 0.1]; the part's extent as least_cad_extent_mm says
/// @fails CadError when the shape cannot be built or the file lost something, IoError when it cannot be
///        written, InputError for an invalid option; then no file is left
/// @error lengths in the file are the profile's to the last bit in mm, to one rounding in other units
/// @cost  some 10 ms; one export at a time in a process (a lock waits for the other)
ExportReport export_reflector(const Profile& profile, const std::filesystem::path& path,
                              const ExportOptions& options = {});

}  // namespace catoptric::cad
