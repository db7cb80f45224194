#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "sim/kernel.h"
#include "sim/stored_photons.h"
#include "sim/tracer.h"

namespace catoptric::sim {

/// How photons become irradiance. Exactly one of the two bandwidths is set.
struct EstimateOptions {
  Kernel kernel = Kernel::silverman;
  std::optional<std::size_t>
      neighbours;  ///< paper eq. 8: the nearest N photons, r is the farthest's distance
  std::optional<double> kernel_radius_mm;  ///< all photons within a fixed radius
};

/// @fails InputError when both or neither bandwidth is set, neighbours is 0, or the radius is not positive
void check(const EstimateOptions& options);

/// How far beyond an invisible near field's patch photons must be recorded for these estimates: the fixed
/// radius, or for the nearest N, whose radius is not known before, the patch's larger half width. (An
/// estimate that reaches farther is corrected for the kernel's mass outside, see edge_correction.h.)
double recording_margin_mm(const NearField& field, const EstimateOptions& options);

/// Irradiance from stored photons at many points, in the order of the points.
struct MapEstimate {
  std::vector<double> irradiance;        ///< W/mm^2
  std::vector<double> noise;             ///< standard deviation of it, W/mm^2
  std::vector<double> kernel_radius_mm;  ///< bandwidth of each
  std::vector<std::size_t> photons;      ///< within that radius
};

/// Photons on the near field's plane, searchable; each side of the plane has a map of its own.
class PhotonMap {
 public:
  /// Takes the photons over: band after band of the plane is sorted into a grid (see PhotonGrid) and its
  /// share of `traced` freed, so that few bands are twice in memory.
  /// @cost O(n), in parallel; about 17 bytes a photon, grid included
  PhotonMap(const NearField& field, TracedPhotons traced);
  ~PhotonMap();
  PhotonMap(PhotonMap&&) noexcept;
  PhotonMap& operator=(PhotonMap&&) noexcept;

  /// Photons stored on the side of a plane that `normal` looks to.
  std::size_t size(const Vector3& normal) const;

  /// Irradiance at the samples from the photons that arrived on the samples' side.
  ///
  /// With N neighbours r is the distance of the farthest of the N nearest photons, of all when fewer are
  /// stored; with a fixed radius r is that radius. The sum is divided by the share of the kernel's mass on
  /// the recorded area. The noise is that of a sum over independent photons, sqrt(sum of squared weights):
  /// for Sobol points, which are spread more evenly than chance, it is an upper bound.
  /// @in    samples on the near field's patch
  /// @out   never negative, exactly 0 without photons; the same bits for any number of threads
  /// @fails as check(options)
  /// @error bias grows like the square of the radius, for a smooth field; noise like 1 / (radius sqrt(n))
  /// @cost  O(photons within the radius) a sample, in parallel
  /// @from  paper eq. 8
  MapEstimate estimate(std::span<const FieldSample> samples, const EstimateOptions& options) const;

  /// About so many photons of both sides, spread over all of them as they lie.
  std::vector<StoredPhoton> some(std::size_t wanted) const;

  /// Irradiance at the samples under the Silverman kernel with a ladder of fixed radii, each narrower than
  /// the one before by the root of two, W/mm^2.
  /// @in    as estimate(); a positive radius
  /// @out   [level][sample], widest first; as estimate() gives it, to rounding
  /// @cost  that of the widest radius alone, some 1 ns a photon within it
  std::vector<std::vector<double>> ladder(std::span<const FieldSample> samples, double widest_radius_mm,
                                          std::size_t levels) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace catoptric::sim
