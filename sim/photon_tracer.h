#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "sim/flight_counts.h"
#include "sim/light_paths.h"
#include "sim/opening.h"
#include "sim/tracer.h"

namespace catoptric::sim {

/// What a chunk of photons has left.
struct ChunkResult {
  std::vector<Crossing> crossings;
  std::vector<Ray> departures;  ///< of photons that left, where these are asked for
  FlightCounts counts;
};

/// What every task of a set shares. Borrowed for the duration of a call.
struct Flight {
  const Scene& scene;
  const PhotonOptions& options;
  const Emission& emission;
  const RecordedArea& area;
  const std::optional<Opening>& opening;
  std::uint64_t key;
  double lift_mm;
  bool departs = false;                ///< there is no near field; where photons go is what is asked for
  const Surroundings* room = nullptr;  ///< null: mirror and near field are all there is
  const std::vector<RecordedArea>* more = nullptr;  ///< of the room's fields
  std::vector<LightPath>* paths = nullptr;          ///< of photon i at i; null: they are not kept
};

/// Traces photons in three dimensions through all their bounces.
/// @in    [first, last): their numbers
/// @out   crossings in the order of the photons; the same whatever the thread
ChunkResult trace_in_space(const Flight& flight, std::uint64_t first, std::uint64_t last);

}  // namespace catoptric::sim
