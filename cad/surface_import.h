#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>

#include "base/surface_shape.h"

namespace catoptric::cad {

struct SurfaceImportOptions {
  double chord_error = 1e-3;  ///< of triangles against curved faces, over the part's size
  std::optional<std::chrono::milliseconds> time_limit = {};  ///< nothing: 20 s, and 2 s more for each MiB
};

/// Faces of a file as light meets them.
struct ImportedSurface {
  std::shared_ptr<const SurfaceShape> shape;
  std::shared_ptr<const Facets> facets;  ///< its triangles, by the numbers that meetings name
  std::size_t faces;
  Vector3 least_mm, greatest_mm;  ///< corners of the box that holds them
};

/// All faces of an IGES or STEP file (told apart by their content), as triangles in Embree.
///
/// Flat faces are exact to 1e-7 of the part's size, which is a float's resolution; curved ones are facets
/// with normals of their own, so that they are good for walls, lamps' bodies and baffles, and not for mirrors
/// that are to make an image.
/// @in    file in any unit of length; result in mm
/// @fails CadError when there is no file, it is neither IGES nor STEP or broken, or holds no face; InputError
///        for a chord error out of [1e-6, 0.1]
/// @cost  some 10 ms and what OpenCASCADE takes; the file is read in a child process, since a broken one can
///        kill or hang OCCT. A ray takes 0.2 to 1 us
ImportedSurface import_surface(const std::filesystem::path& file, const SurfaceImportOptions& options = {});

}  // namespace catoptric::cad
