#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <string>

#include "sim/source.h"

namespace catoptric::sim {

/// The rays of a measured source, each the oftener picked the more light it carries. Safe to ask from many
/// threads.
class RayBundle {
 public:
  virtual ~RayBundle() = default;

  /// Rays that carry light.
  virtual std::uint64_t count() const = 0;

  /// @in    number: in [0, 1)
  /// @out   the ray up to which this share of all light is carried, in the frame of the bundle
  virtual Ray pick(double number) const = 0;

  /// A ball about the frame's origin that holds all starting points.
  virtual double extent_mm() const = 0;
};

/// Independent parts of a bundle that sets of photons take in turn. Rays of one part are never another's, but
/// for a few at the borders, so that the spread of the sets shows what the bundle itself does not know.
inline constexpr std::uint64_t parts_of_a_bundle = 8;

/// A source that is known by rays alone, as goniophotometers with cameras measure LEDs. Its photons are these
/// rays and no others: it has no direct light that could be computed, so photons bring that too, and their
/// noise never falls below the bundle's own.
class RaySource final : public Source {
 public:
  /// @in    position: of the bundle's origin; axis: the direction of its z; along: that of its x, made
  ///        perpendicular to the axis
  /// @fails InputError as PointSource, and for `along` parallel to the axis
  RaySource(const Vector3& position_mm, double power_w, std::shared_ptr<const RayBundle> rays,
            const Vector3& axis, const Vector3& along);
  double power_w() const override { return power_w_; }
  Vector3 position_mm() const override { return position_mm_; }
  double extent_mm() const override { return rays_->extent_mm(); }
  double tilt_rad() const override { return tilt_of(frame_.col(2)); }
  bool is_round() const override { return false; }
  bool is_sampled() const override { return true; }
  double intensity_w_per_sr(const Vector3&) const override { return 0; }
  std::string words() const override;
  std::string left_out() const override;
  /// All rays: those that miss the mirror are the direct light.
  std::unique_ptr<Emission> emission_to(const Profile&) const override { return emission(); }
  std::unique_ptr<Emission> emission() const override;
  double unhindered_w_per_mm2(const Vector3&, const Vector3&) const override { return 0; }
  double direct_w_per_mm2(const Vector3&, const Vector3&, Probe&, double) const override { return 0; }

 private:
  Vector3 position_mm_;
  double power_w_;
  std::shared_ptr<const RayBundle> rays_;
  Eigen::Matrix3d frame_;  ///< columns: the bundle's x, y, z
};

}  // namespace catoptric::sim
