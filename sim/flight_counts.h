#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "sim/tracer.h"

namespace catoptric::sim {

/// How a photon's path ended.
enum class Fate { missed, absorbed, received, escaped, cut_off, stopped, stopped_untouched };
inline constexpr std::size_t fates = 7;

/// What is counted of some photons.
struct FlightCounts {
  std::array<std::uint64_t, fates> ended{};  ///< photons by Fate
  std::uint64_t met_mirror = 0, interactions = 0, stored = 0;

  void add(const FlightCounts& part) {
    for (std::size_t i = 0; i < ended.size(); ++i) ended[i] += part.ended[i];
    met_mirror += part.met_mirror;
    interactions += part.interactions;
    stored += part.stored;
  }
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

  FlightCounts counted() const {
    FlightCounts counts{{}, met_mirror_, interactions_, stored_};
    for (std::size_t i = 0; i < ended_.size(); ++i) counts.ended[i] = ended_[i];
    return counts;
  }

  /// Totals of `photons` photons that share `emitted_w`. From the first meeting with the mirror on, each
  /// carries a share of its power; the rest is absorbed.
  FlightTotals totals(std::uint64_t photons, double emitted_w, double share) const {
    FlightTotals totals;
    const double before_w = photons > 0 ? emitted_w / static_cast<double>(photons) : 0;
    totals.energy.emitted_w = photons > 0 ? emitted_w : 0;
    totals.photon_power_w = share * before_w;
    totals.counts = {photons, met_mirror_, stored_, interactions_};
    const auto count = [&](Fate fate) { return ended_[static_cast<std::size_t>(fate)].load(); };
    const auto power = [&](std::uint64_t n) { return static_cast<double>(n) * totals.photon_power_w; };
    // Of those cut off, some had met nothing but the near field. (Where photons may be received or stopped
    // without the mirror, all carry the same.)
    const std::uint64_t untouched =
        share < 1 ? photons - count(Fate::missed) - count(Fate::stopped_untouched) - met_mirror_ : 0;
    totals.energy.missed_w = static_cast<double>(count(Fate::missed)) * before_w;
    totals.energy.absorbed_w = power(count(Fate::absorbed)) +
                               static_cast<double>(met_mirror_.load()) * (before_w - totals.photon_power_w);
    totals.energy.stopped_w =
        power(count(Fate::stopped)) + static_cast<double>(count(Fate::stopped_untouched)) * before_w;
    totals.energy.received_w = power(count(Fate::received));
    totals.energy.escaped_w = power(count(Fate::escaped));
    totals.energy.cut_off_w =
        power(count(Fate::cut_off) - untouched) + static_cast<double>(untouched) * before_w;
    return totals;
  }

 private:
  std::array<std::atomic<std::uint64_t>, fates> ended_{};
  std::atomic<std::uint64_t> met_mirror_ = 0, interactions_ = 0, stored_ = 0;
};

}  // namespace catoptric::sim
