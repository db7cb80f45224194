#pragma once

#include <algorithm>
#include <vector>

#include "sim/tracer.h"

namespace catoptric::test {

/// Photons after their flight with all that is known of each, joined in the order of their numbers.
struct Flown {
  std::vector<sim::Crossing> crossings;
  double photon_power_w;
  sim::EnergyLedger energy;
  sim::PhotonCounts counts;
};

inline Flown fly(const sim::Scene& scene, const sim::PhotonOptions& options, double margin_mm,
                 sim::FlightSpace space = sim::FlightSpace::as_needed) {
  std::vector<std::vector<sim::Crossing>> chunks(
      sim::PhotonFlights::chunks(std::min(options.photons, sim::most_photons)));
  const sim::PhotonFlights flights(scene, sim::RecordedArea::about(scene.near_field, margin_mm), space);
  const sim::FlightTotals totals = flights.fly(
      options,
      [&](std::uint64_t i, std::vector<sim::Crossing>&& crossings) { chunks[i] = std::move(crossings); });
  Flown flown{{}, totals.photon_power_w, totals.energy, totals.counts};
  for (const auto& chunk : chunks) flown.crossings.insert(flown.crossings.end(), chunk.begin(), chunk.end());
  return flown;
}

}  // namespace catoptric::test
