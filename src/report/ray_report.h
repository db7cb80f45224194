#pragma once

#include "design/ray_output.h"
#include "report/run_files.h"
#include "report/table.h"

namespace catoptric::report {

/// Room on the disk that a ray file of the scene asks for.
std::uint64_t room_for_rays(const design::Scene& scene);

/// A ray file that was written and read back.
struct WrittenRays {
  design::RayOutput output;
  double file_flux = 0;    ///< sum of the file's rays, each a float: W or lm
  double extent_mm = 0;    ///< radius of a ball about the frame's origin that holds all starting points
  Vector3 mean_direction;  ///< in the frame
  double seconds = 0;
};

/// Writes `source.tm25ray` or `source.dat` (`luminaire.*` of one), `source.toml` (the keys by which a scene
/// has it for its source), `scene.toml` and `rays.json`. Rays go to the disk batch by batch; the file is read
/// back, checked and appears whole or not at all.
/// @fails InputError, IoError, Interrupted
std::pair<WrittenFiles, WrittenRays> write_rays(const design::Scene& scene, const design::RunControl& control,
                                                const std::filesystem::path& folder);

/// What a user wants to see of it.
Table ray_table(const WrittenRays& rays);

}  // namespace catoptric::report
