#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "sim/tracer.h"

namespace catoptric::sim {

/// How a photon's path ended.
enum class Fate { missed, absorbed, received, escaped, cut_off };

/// What is counted of some photons.
struct FlightCounts {
  std::array<std::uint64_t, 5> ended{};  ///< photons by Fate
  std::uint64_t met_mirror = 0, interactions = 0, stored = 0;
};

/// What all tasks together counted. Whole numbers, so that their order does not matter.
class SharedCounts {
 public:
  void add(const FlightCounts& part) {
    for (std::size_t i = 0; i < ended_.size(); ++i) ended_[i] += part.ended[i];
    met_mirror_ += part.met_mirror;
    interactions_ += part.interactions;
    stored_ += part.stored;
  }

  /// Totals of `photons` photons that share `emitted_w`.
  FlightTotals totals(std::uint64_t photons, double emitted_w) const {
    FlightTotals totals;
    totals.energy.emitted_w = photons > 0 ? emitted_w : 0;
    totals.photon_power_w = photons > 0 ? emitted_w / static_cast<double>(photons) : 0;
    totals.counts = {photons, met_mirror_, stored_, interactions_};
    const auto power_of = [&](Fate fate) {
      return static_cast<double>(ended_[static_cast<std::size_t>(fate)]) * totals.photon_power_w;
    };
    totals.energy.missed_w = power_of(Fate::missed);
    totals.energy.absorbed_w = power_of(Fate::absorbed);
    totals.energy.received_w = power_of(Fate::received);
    totals.energy.escaped_w = power_of(Fate::escaped);
    totals.energy.cut_off_w = power_of(Fate::cut_off);
    return totals;
  }

 private:
  std::array<std::atomic<std::uint64_t>, 5> ended_{};
  std::atomic<std::uint64_t> met_mirror_ = 0, interactions_ = 0, stored_ = 0;
};

}  // namespace catoptric::sim
