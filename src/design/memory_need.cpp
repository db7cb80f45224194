#include "design/memory_need.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "base/memory_limit.h"
#include "design/evaluator.h"
#include "design/run.h"
#include "sim/bandwidth_ladder.h"
#include "sim/photon_fields.h"

namespace catoptric::design {
namespace {

constexpr std::uint64_t program_bytes = 120'000'000;  // its libraries, files on their way out, bins of rings
/// Direct, wide, narrow, noise, bias and what they are joined from, for each replicate.
constexpr std::uint64_t numbers_of_a_sample = 8;
constexpr std::uint64_t numbers_sent = 16;  ///< the same once more as bytes, on their way among ranks

std::string size(std::uint64_t bytes) {
  const double megabytes = static_cast<double>(bytes) / 1e6;
  return megabytes < 1000 ? fmt::format("{:.0f} MB", megabytes) : fmt::format("{:.3g} GB", megabytes / 1000);
}

std::uint64_t all_samples(const Scene& scene) {
  std::uint64_t samples = scene.samples;
  for (const FieldSpec& field : scene.fields) samples += field.samples;
  return samples;
}

bool proof_keeps_photons(const Scene& scene) {
  return scene.accuracy_rel && simulation_plan(scene, start_candidate(scene)).rung == sim::Rung::photons;
}

}  // namespace

MemoryNeed memory_need(const Scene& scene, int ranks) {
  const sim::EstimateOptions& bandwidth = scene.model.estimate;
  // Each field has a map of its own; of a fixed radius all maps together hold one batch.
  const std::uint64_t maps = bandwidth.neighbours ? 1 + scene.fields.size() : 1;
  const std::uint64_t photons = maps * sim::photon_memory_bytes(scene.model.photons.photons, bandwidth);
  const std::uint64_t samples = (numbers_of_a_sample + (ranks > 1 ? numbers_sent : 0)) * sizeof(double) *
                                all_samples(scene) * scene.model.replicates;
  if (proof_keeps_photons(scene)) {
    const std::uint64_t kept = sim::most_kept_by_a_rank(scene.model.most_photons, ranks);
    const std::uint64_t proof = sim::bytes_of_a_stored_photon * kept;
    const std::uint64_t bytes = program_bytes + samples + std::max(proof, photons);
    return {bytes,
            fmt::format("at most {}: proving the accuracy may keep {} photons (model.most_photons{})",
                        size(bytes), kept, ranks > 1 ? ", a rank's part of them" : ""),
            "model.most_photons", "fewer photons, or a scene that rings or tubes can compute"};
  }
  const std::uint64_t bytes = program_bytes + samples + photons;
  if (bandwidth.neighbours)
    return {
        bytes,
        fmt::format("at most {}: all photons are kept, since the nearest are only known when all are there",
                    size(bytes)),
        "model.photons",
        "model.kernel_radius instead of model.neighbours, which takes the same for any number of photons"};
  return {bytes,
          fmt::format("at most {}: however many photons, since they are summed batch by batch", size(bytes)),
          "near_field.samples", "fewer near_field.samples or model.replicates"};
}

std::uint64_t photons_that_fit() {
  const auto available = available_memory_bytes();
  if (!available) return std::numeric_limits<std::uint64_t>::max();
  return (*available - std::min(*available, program_bytes)) / sim::bytes_of_a_stored_photon;
}

bool fits_memory(const Scene& scene) {
  const auto available = available_memory_bytes();
  return !available || memory_need(scene).bytes <= *available;
}

void require_memory(const Scene& scene, int ranks, int ranks_here) {
  const MemoryNeed need = memory_need(scene, ranks);
  const auto available = available_memory_bytes();
  const auto here = static_cast<std::uint64_t>(ranks_here);
  if (!available || need.bytes * here <= *available) return;
  const std::string beside = here > 1 ? fmt::format(" for {} ranks on this machine", here) : "";
  throw scene.settings.error(need.key, "the scene would not fit into memory",
                             fmt::format("{}; {} are free{}", need.sentence, size(*available), beside),
                             need.hint);
}

}  // namespace catoptric::design
