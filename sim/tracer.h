#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "base/ranks.h"
#include "sim/emission.h"
#include "sim/recorded_area.h"
#include "sim/scene.h"
#include "sim/stored_photons.h"

namespace catoptric::sim {

struct PhotonOptions {
  std::uint64_t photons = 100'000;  ///< emitted towards the reflector; 0 is allowed and gives a dark field
  Sampler sampler = Sampler::random;
  std::uint64_t seed = 1;
  std::uint64_t stream = 0;  ///< another stream is another independent set of photons
  int most_interactions = 1000;
  const std::atomic<bool>* stop = nullptr;  ///< true: photons in flight are given up with Interrupted
  Ranks* ranks = nullptr;  ///< that batches of photons are shared by; null: this process alone
};

/// Where the emitted power went. Photons are counted as whole numbers, so the parts add up to emitted_w
/// within some roundings.
struct EnergyLedger {
  double emitted_w = 0;   ///< to where the mirror may be met
  double missed_w = 0;    ///< met no mirror: left, or ended on the near field's own surface untouched
  double absorbed_w = 0;  ///< in the mirror
  double stopped_w = 0;   ///< in objects that are no field: baffles, walls, glass
  double received_w = 0;  ///< absorbed by a field after touching mirror or surroundings, or crossed an
                          ///< invisible field's own area against its normal at least once and then left
  double escaped_w = 0;   ///< touched the mirror and left without being received
  double cut_off_w = 0;   ///< stopped after most_interactions

  /// Adds a share of another ledger: the mean of n sets is the sum of their n-ths.
  void add(const EnergyLedger& part, double share) {
    emitted_w += share * part.emitted_w;
    missed_w += share * part.missed_w;
    absorbed_w += share * part.absorbed_w;
    stopped_w += share * part.stopped_w;
    received_w += share * part.received_w;
    escaped_w += share * part.escaped_w;
    cut_off_w += share * part.cut_off_w;
  }
};

struct PhotonCounts {
  std::uint64_t emitted = 0;
  std::uint64_t met_mirror = 0;    ///< photons that touched the mirror at least once
  std::uint64_t stored = 0;        ///< meetings with the near field's plane that were recorded
  std::uint64_t interactions = 0;  ///< with the mirror and with a real near field, all photons together

  void add(const PhotonCounts& part) {
    emitted += part.emitted;
    met_mirror += part.met_mirror;
    stored += part.stored;
    interactions += part.interactions;
  }
};

/// A photon that met a field's plane after touching the mirror, as it is handed over by its chunk.
struct Crossing {
  double x_mm, y_mm;              ///< plane coordinates of the field
  std::uint64_t photon_and_side;  ///< twice the photon's number, plus 1 when it arrived against the normal;
                                  ///< and above these the field (FieldSample::field)
  static constexpr int field_bits_at = 40;
  Vector2 plane_mm() const { return {x_mm, y_mm}; }
  std::uint64_t photon() const { return (photon_and_side & ((std::uint64_t{1} << field_bits_at) - 1)) >> 1; }
  std::size_t field() const { return photon_and_side >> field_bits_at; }
  bool from_front() const { return (photon_and_side & 1) != 0; }
  bool operator==(const Crossing&) const = default;
};

/// The stored photons of one chunk of photons, in the order of their numbers.
struct StoredChunk {
  BandedPhotons front, back;  ///< by the side they arrived at
};
/// Those of one field.
StoredChunk store(std::span<const Crossing> crossings, const RecordedArea& area, std::size_t field = 0);

/// Photons after their flight.
struct TracedPhotons {
  std::vector<StoredChunk> chunks;  ///< in the order of the photons
  RecordedArea area;                ///< all crossings of this area are there
  double photon_power_w = 0;
  EnergyLedger energy;
  PhotonCounts counts;
};

/// Photons of one task. Fixed, since the joined result must not depend on the number of threads; small, so
/// that even ten thousand photons feed several cores.
inline constexpr std::uint64_t photons_of_a_chunk = 1024;

/// @fails InputError for more than most_photons photons, most_interactions below 1
void check(const PhotonOptions& options);

/// For the beginning of each chunk of photons.  @fails Interrupted once options.stop is true
void give_up_if_stopped(const PhotonOptions& options);

/// Where photons are sent: what reflects may light the mirror from anywhere; else only the mirror's own
/// directions matter (transmission goes straight on, so it needs no others).
/// @fails InputError for a bad mirror material
std::unique_ptr<const Emission> emission_of(const Scene& scene);

/// The share of its power that a photon carries on from its first meeting with the mirror, unless chance
/// decides there too: where photons are recorded that met no mirror, all carry the same.
double first_share(const Scene& scene);

/// What is known of a set of photons after their flight, without the crossings.
struct FlightTotals {
  double photon_power_w = 0;  ///< of one that has met the mirror: what survives its first meeting
  EnergyLedger energy;
  PhotonCounts counts;
};

/// Takes the crossings of one chunk of photons, in the order of their numbers; called for every chunk once,
/// from several threads and in any order.
using TakeCrossings = std::function<void(std::uint64_t chunk, std::vector<Crossing>&& crossings)>;

/// Whether photons that stay in their meridian planes are traced there, or in space like all others.
enum class FlightSpace { as_needed, always_space };

struct FlightCounts;  // flight_counts.h

/// Photons ready to fly: what does not depend on their numbers is prepared once for any number of sets, and
/// the crossings are handed over as they come, so that memory need not grow with the photons. After the
/// mirror no intersection is looked for where its shape excludes one (see Opening).
class PhotonFlights {
 public:
  /// @in    what the scene borrows must outlive this
  /// @fails InputError for a bad mirror material
  PhotonFlights(const Scene& scene, const RecordedArea& area, FlightSpace space = FlightSpace::as_needed);
  /// The same with what is recorded of the further fields of the surroundings; without it nothing is.
  PhotonFlights(const Scene& scene, const RecordedArea& area, std::vector<RecordedArea> more);
  ~PhotonFlights();

  /// From now on crossings of another area are handed over.
  void record(const RecordedArea& area);
  const RecordedArea& area() const;

  /// Chunks of a set of so many photons.
  static std::uint64_t chunks(std::uint64_t photons);

  /// @fails InputError for more than most_photons photons, most_interactions below 1; Interrupted once
  ///        options.stop is true
  FlightTotals fly(const PhotonOptions& options, const TakeCrossings& take) const;

  /// A part of a set, for takers that must not keep all crossings and for sets that processes share: chunks
  /// `first` .. `end` - 1 alone, and what was counted of them.
  FlightCounts fly_chunks(const PhotonOptions& options, const TakeCrossings& take, std::uint64_t first,
                          std::uint64_t end) const;

  /// The totals of a set of so many photons of which all parts together counted this.
  FlightTotals totals(std::uint64_t photons, const FlightCounts& counted) const;

  /// Power of one of so many photons once it has met the mirror, W.
  double photon_power_w(std::uint64_t photons) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Takes the rays on which photons of one chunk leave for good, from where they last left the mirror or the
/// source; called for every chunk once, from several threads and in any order.
using TakeDepartures = std::function<void(std::uint64_t chunk, std::span<const Ray> rays)>;

/// All of the source's photons through the mirror and away, as if there were no near field and no room: of
/// the surroundings only what belongs to the luminaire is there.
/// @out   photon_power_w: of each that leaves; nothing is received
/// @fails as PhotonFlights::fly
FlightTotals depart(const Scene& scene, const PhotonOptions& options, const TakeDepartures& take);

/// First pass of the photon map: emission towards the mirror, Russian roulette at every surface, crossings of
/// the near field's plane recorded once the mirror has been touched, out to `margin_mm` beyond the patch of
/// an invisible near field.
/// @out   the same bits for any number of threads; photon i gets the same numbers whatever the engine
/// @fails InputError for more than most_photons photons, most_interactions below 1, or a bad mirror material
/// @cost  photons times one or two intersections; 17 bytes per crossing
/// @from  paper section 4.4, stage 1
TracedPhotons trace_photons(const Scene& scene, const PhotonOptions& options, double margin_mm);
/// Chunks `first` .. `end` - 1 of a set alone, with flights prepared before.
/// @out   without energy and counts, which are the set's: what was counted of these is `counted`
TracedPhotons trace_chunks(const PhotonFlights& flights, const PhotonOptions& options, std::uint64_t first,
                           std::uint64_t end, FlightCounts& counted);

}  // namespace catoptric::sim
