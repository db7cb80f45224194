#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <span>

#include "design/run.h"

namespace catoptric::design {

/// The frame that rays are written in: columns are its x, y, z in the scene.
struct RayFrame {
  Vector3 origin_mm = Vector3::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
};

/// Rays that stand for the scene's light, as they are asked for by the keys `rays`.
struct RayOutput {
  RayFrame frame;
  LightQuantity quantity{};
  double source_flux = 0;     ///< of the scene's source, W or lm
  double ray_flux = 0;        ///< of each ray
  std::uint64_t emitted = 0;  ///< rays that the source sent out
  std::uint64_t rays = 0;     ///< of these handed over
};

/// The source's own frame: origin at its position, z along its axis, x along the direction that counts there;
/// the scene's axes for what has none (several sources, points and spheres that shine alike all round).
RayFrame own_frame(const SourceSpec& spec);

/// Draws the rays on fresh streams and hands them over in the frame, in order, batch after batch.
/// @fails InputError for a Zemax file of more rays than one can hold; Interrupted
/// @cost  bounded memory for any number of rays
RayOutput run_rays(const Scene& scene, const RunControl& control,
                   const std::function<void(std::span<const Ray>)>& take);

}  // namespace catoptric::design
