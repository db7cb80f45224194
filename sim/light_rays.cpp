#include "sim/light_rays.h"

#include <algorithm>
#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "base/errors.h"
#include "base/random_stream.h"
#include "sim/ray_source.h"
#include "sim/side_by_side.h"
#include "sim/tracer.h"

namespace catoptric::sim {
namespace {

constexpr std::uint64_t most_rays_of_a_batch = std::uint64_t{1} << 20;

struct RayBatch {
  std::uint64_t count, stream;
};

/// As many as the parts of a ray file, or some times that, so that a source made of one gives all of them
/// alike.
std::vector<RayBatch> batches(const RayOptions& options) {
  const std::uint64_t rounds =
      1 + (options.count > 0 ? (options.count - 1) / (parts_of_a_bundle * most_rays_of_a_batch) : 0);
  const std::uint64_t number = rounds * parts_of_a_bundle, whole = options.count / number,
                      more = options.count % number;
  std::vector<RayBatch> list;
  for (std::uint64_t i = 0; i < number; ++i)
    if (const std::uint64_t count = whole + (i < more ? 1 : 0); count > 0)
      list.push_back({count, options.first_stream + 1 + i});
  return list;
}

/// Sobol points and waves of the tracer put alike rays at like places of a chunk; chance does away with that.
/// @from  Fisher & Yates 1938; Durstenfeld 1964
void shuffle(std::vector<Ray>& rays, std::uint64_t key, std::uint64_t chunk) {
  RandomStream chance(key, Purpose::order, chunk);
  for (std::size_t i = rays.size(); i > 1; --i) {
    const auto j = static_cast<std::size_t>(chance.uniform() * static_cast<double>(i));
    std::swap(rays[i - 1], rays[j]);
  }
}

void hand_over(std::vector<std::vector<Ray>>& chunks, std::uint64_t key, const TakeRays& take) {
  side_by_side(chunks.size(), [&](std::size_t i) { shuffle(chunks[i], key, i); });
  for (const std::vector<Ray>& chunk : chunks) take(chunk);
}

std::vector<Ray> emitted_chunk(const Emission& emission, const EmissionNumbers& numbers, std::uint64_t stream,
                               std::uint64_t first, std::uint64_t last) {
  const std::size_t rows = emission.numbers();
  std::array<std::vector<double>, most_emission_numbers> drawn;
  std::array<std::span<double>, most_emission_numbers> spans;
  for (std::size_t row = 0; row < rows; ++row) {
    drawn[row].resize(last - first);
    spans[row] = drawn[row];
  }
  numbers.draw(first, std::span(spans).first(rows));
  std::vector<Ray> rays;
  rays.reserve(last - first);
  for (std::size_t i = 0; i < last - first; ++i) {
    std::array<double, most_emission_numbers> own{};
    for (std::size_t row = 0; row < rows; ++row) own[row] = drawn[row][i];
    rays.push_back(emission.emit(own, stream));
  }
  return rays;
}

PhotonOptions photons_of(const RayOptions& options, const RayBatch& batch) {
  PhotonOptions photons;
  photons.photons = batch.count;
  photons.sampler = options.sampler;
  photons.seed = options.seed;
  photons.stream = batch.stream;
  photons.most_interactions = options.most_interactions;
  photons.stop = options.stop;
  return photons;
}

}  // namespace

void source_rays(const Source& source, const RayOptions& options, const TakeRays& take) {
  const std::unique_ptr<const Emission> emission = source.emission();
  for (const RayBatch& batch : batches(options)) {
    const PhotonOptions photons = photons_of(options, batch);
    const std::uint64_t key = photon_key(options.seed, batch.stream);
    const EmissionNumbers numbers(options.sampler, key);
    std::vector<std::vector<Ray>> chunks(PhotonFlights::chunks(batch.count));
    side_by_side(chunks.size(), [&](std::size_t i) {
      give_up_if_stopped(photons);
      const std::uint64_t first = i * photons_of_a_chunk;
      chunks[i] = emitted_chunk(*emission, numbers, batch.stream, first,
                                std::min(first + photons_of_a_chunk, batch.count));
    });
    hand_over(chunks, key, take);
  }
}

void luminaire_rays(const Scene& scene, const RayOptions& options, const TakeRays& take) {
  for (const RayBatch& batch : batches(options)) {
    std::vector<std::vector<Ray>> chunks(PhotonFlights::chunks(batch.count));
    depart(scene, photons_of(options, batch), [&](std::uint64_t chunk, std::span<const Ray> rays) {
      chunks[chunk].assign(rays.begin(), rays.end());
    });
    hand_over(chunks, photon_key(options.seed, batch.stream), take);
  }
}

}  // namespace catoptric::sim
