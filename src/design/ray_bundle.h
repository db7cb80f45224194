#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "base/light_units.h"
#include "sim/ray_source.h"

namespace catoptric::design {

/// A ray file as a source has it.
struct RayFileLight {
  std::shared_ptr<const sim::RayBundle> rays;
  LightQuantity quantity;  ///< of the fluxes that were read
  double flux;             ///< their sum, W or lm
};

/// Opens a ray file and looks at all of its rays.
/// @in    wanted: which flux to read where the file has both; radiant flux when left out
/// @fails InputError with file, ray, field and rule
/// @cost  four passes over the file; 125 MB of memory for 1e9 rays
RayFileLight read_rays(const std::filesystem::path& file, std::optional<LightQuantity> wanted);

}  // namespace catoptric::design
