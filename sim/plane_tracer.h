#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/planar_hits.h"
#include "sim/flight_counts.h"
#include "sim/opening.h"
#include "sim/tracer.h"

namespace catoptric::sim {

/// What photons need that never leave their meridian planes: a point source on the axis that shines alike
/// round it, a smooth mirror of revolution, and nothing that scatters. The near field may lie anywhere at any
/// tilt: the way to it is straight, and the plane it lies in does not matter to the way.
struct PlaneScene {
  /// Whether photons stay in their planes: a point source on the axis that shines alike round it, a smooth
  /// mirror, a near field that reflects nothing, and the engine that agrees with the plane one to rounding,
  /// "meridian" (the others are there to be asked).
  static bool possible(const Scene& scene);

  PlaneScene(const Scene& scene, const RecordedArea& area);
  Scene scene;
  RecordedArea area;
  RecordedArea patch;  ///< the near field's own area
  PlanarMirror mirror;
  std::optional<Opening> opening;
  double lift_mm;
};

/// Where photons leave the source: the cosine of the polar angle, and cosine and sine of the azimuth, which
/// is that of their meridian planes.
struct PlaneEmission {
  std::span<const double> cosine, azimuth_cosine, azimuth_sine;
};

/// Traces photons of one task, each in its meridian plane, with the fates and crossings the tracer in space
/// gives them. What most photons do, to be reflected once and leave through the mouth, is done for many at a
/// time; the others are followed one by one.
class PlaneTracer {
 public:
  /// @in key of photon_key()
  PlaneTracer(const PlaneScene& scene, int most_interactions, std::uint64_t key)
      : scene_(scene), most_interactions_(most_interactions), key_(key) {}

  /// Traces photons `first`, first + 1, ... and appends their crossings in the order of their numbers.
  void trace(std::uint64_t first, const PlaneEmission& emission);

  std::vector<Crossing>& crossings() { return crossings_; }
  const FlightCounts& counts() const { return counts_; }

 private:
  struct Photon;
  struct Arrival;
  struct Block;
  void trace_block(std::uint64_t first, Block& block);
  /// Of a photon that was reflected once and leaves for good; whether the near field has received it.
  bool record_leaving(std::uint64_t number, const Block& block, std::size_t i);
  Fate settle(std::uint64_t number, const Block& block, std::size_t i);
  Fate follow(Photon& photon);
  std::optional<PlanarHit> next_hit(const Photon& photon) const;
  std::optional<Arrival> meet_plane(const Photon& photon, double reach_mm) const;
  /// Whether the near field has received it.
  bool record(std::uint64_t number, const Arrival& arrival);
  bool leave_mirror(Photon& photon, const PlanarHit& hit);
  double chance_of(Photon& photon) const;
  Interaction decide(const Material& material, Roulette roulette, double cosine, Photon& photon) const;

  const PlaneScene& scene_;
  int most_interactions_;
  std::uint64_t key_;
  std::vector<Crossing> crossings_;
  FlightCounts counts_;
};

}  // namespace catoptric::sim
