#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sim/ring_kernel.h"
#include "sim/ring_store.h"
#include "sim/scene.h"
#include "sim/tracer.h"

namespace catoptric::sim {

/// How rings keep the photons between flight and estimate.
enum class RingStorage {
  counted,  ///< in fine bins of r^2: fixed memory, whatever the number of photons
  sorted,   ///< every photon, 8 bytes each: the reference
};

struct RingsOptions {
  PhotonOptions photons;         ///< `photons` in all, shared by the replicates
  std::uint64_t replicates = 4;  ///< sets of unrelated random numbers, from whose spread the noise follows
  RingKernel kernel = RingKernel::biweight;
  std::optional<double> bandwidth_mm2;  ///< half width of the kernel in r^2; nothing: chosen by the estimated
                                        ///< mean integrated squared error
  double widest_kernel_radius_mm = 0;   ///< that `smoothed` will be asked for
  bool front = true;                    ///< light on the side that the near field's normal looks to
  bool in_plane = true;                 ///< trace in the meridian plane where photons stay in it
  RingStorage storage = RingStorage::counted;
  std::optional<std::size_t> bins;              ///< over the recorded r^2; nothing: by the number of photons
  std::optional<std::vector<double>> edges_mm;  ///< radii where the field jumps; nothing: where the rays of
                                                ///< the mirror's edges land
};

/// Reflected irradiance at radii, W/mm^2, in the order of the radii; never negative.
struct RingsField {
  std::vector<double> irradiance;      ///< second-order estimate, the mean of the replicates
  std::vector<double> noise;           ///< its standard deviation, by the spread of the replicates
  std::vector<double> poisson_noise;   ///< the same if photons were independent: for Sobol points a bound
  std::vector<double> bias;            ///< what smoothing added: second-order less fourth-order estimate
  std::vector<double> debiased;        ///< fourth-order estimate of the same photons
  std::vector<double> debiased_noise;  ///< its standard deviation
  double bandwidth_mm2 = 0;
  std::uint64_t replicates = 0;  ///< that had photons; with fewer than two, noise is poisson_noise
  std::vector<double> edges_mm;  ///< jumps inside the recorded radii that no estimate looks across
  EnergyLedger energy;           ///< mean of the replicates
  PhotonCounts counts;           ///< of all replicates together
  std::size_t memory_bytes = 0;  ///< of the stored photons

  /// Radius of the disc with the area of the ring that an estimate looks at.
  double kernel_radius_mm() const;
  /// The interval debiased +- this holds the truth with the probability `level`; Student's t with
  /// replicates - 1 degrees of freedom. What is left of the bias is not in it.
  double half_interval(std::size_t index, double level) const;
};

/// What forbids to fold the photons about the axis, in words, or nothing.
std::optional<std::string> rings_objection(const Scene& scene);

/// Rung "rings": photons are traced in space and folded about the axis; what is kept of a crossing is
/// s = r^2, for a ring of any place and width ds has the area pi ds, and E(r) = power density(s) / pi. The
/// density is estimated in one dimension by boundary kernels, so that the axis (s = 0), the end of a real
/// field and the sharp edges of the beam are not blurred. The near field may be any patch in a plane across
/// the axis.
///
/// The photons fly when this is made; they can then be looked at with any number of bandwidths.
/// @out   the same bits for any number of threads
/// @fails InputError where rings_objection() has one, for a bandwidth or edge that is no positive finite
///        number, no replicates; as trace_photons
/// @error bias of second order in the bandwidth (`debiased`: fourth order), also on the axis and on edges;
///        noise of random photons like (photons bandwidth)^-1/2, of Sobol points traced in the plane like
///        (photons bandwidth)^-3/2 (sorted) or 1 / (photons bandwidth) (counted); a fold blurs like an edge
///        that is not known
/// @cost  one intersection a photon where the mirror's shape excludes a second, 8 bytes a bin and replicate;
///        of ten thousand photons the bandwidth is chosen in 0.05 ms and 1,024 estimates take 0.1 ms
/// @from  Jones 1993
class RingPhotons {
 public:
  RingPhotons(const Scene& scene, const RingsOptions& options);
  ~RingPhotons();
  RingPhotons(RingPhotons&&) noexcept;

  /// Irradiance at radii with the bandwidth of the options, or the one chosen for these photons.
  /// @in    radii in [0, the farthest point of the near field]
  /// @fails InputError for another radius
  RingsField estimate(std::span<const double> radii_mm);
  /// The same with another bandwidth, no wider than widest_bandwidth_mm2(). Beside steep light these kernels
  /// read less than nothing; it is left so, for what is cut off shows neither spread nor change.
  RingsField estimate(std::span<const double> radii_mm, double bandwidth_mm2);

  /// Irradiance at radii as a photon map with a fixed radius shows it on average: under the Silverman kernel
  /// on discs, with the share of the kernel beyond a real field's edge made up for. Mean of the replicates,
  /// W/mm^2.
  /// @in    a radius no wider than widest_kernel_radius_mm of the options
  std::vector<double> smoothed(std::span<const double> radii_mm, double kernel_radius_mm) const;

  /// All photons of all replicates as rings, places at r^2 mm^2, each standing for a range of about that
  /// width at most.
  RingStore::Places landed(double widest_mm2) const;

  /// Farther from the field's edge no photon was recorded.
  double widest_bandwidth_mm2() const;
  /// What the storage can resolve.
  double least_bandwidth_mm2() const;
  const EnergyLedger& energy() const;
  const PhotonCounts& counts() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Both in one: photons and their estimate.
RingsField rings_field(const Scene& scene, std::span<const double> radii_mm, const RingsOptions& options);

/// Distance from the axis of the near field's farthest point, for a plane across the axis.
double farthest_radius_mm(const NearField& field);

/// Distances of samples from the axis, none beyond the near field by a rounding.
std::vector<double> ring_radii_mm(const NearField& field, std::span<const FieldSample> samples);

}  // namespace catoptric::sim
