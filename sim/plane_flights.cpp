#include "sim/plane_flights.h"

#include <algorithm>
#include <array>

#include "base/random_stream.h"
#include "base/vector_clones.h"
#include "sim/plane_tracer.h"
#include "sim/projection_map.h"
#include "sim/side_by_side.h"

namespace catoptric::sim {

struct PlaneFlights::Parts {
  PlaneScene scene;
  std::unique_ptr<const Emission> emission;
};

namespace {

/// The azimuth of all photons of a chunk.
constexpr std::array<double, photons_of_a_chunk> filled_with(double number) {
  std::array<double, photons_of_a_chunk> all{};
  all.fill(number);
  return all;
}

/// Numbers in [0, 1) become places in the even intervals of that step, one each from number `first` on.
CATOPTRIC_VECTOR_CLONES
void stratify(double first, double step, double* __restrict numbers, std::size_t count) {
  constexpr double below_one = 1 - 0x1p-53;  // the last interval's end may round up
  for (std::size_t i = 0; i < count; ++i) {
    const double place = (first + static_cast<double>(static_cast<int>(i)) + numbers[i]) * step;
    numbers[i] = place < below_one ? place : below_one;
  }
}

/// The one number of the emission that matters in a plane. For the sampler "sobol" photon i of n gets a
/// random place in the i-th of n even intervals, which is what scrambling makes of the first coordinate of
/// 2^k Sobol points, and holds for any n.
class FirstNumbers {
 public:
  FirstNumbers(const PhotonOptions& options, std::uint64_t key, std::uint64_t first)
      : sampler_(options.sampler),
        random_(options.sampler, key),
        step_(1 / static_cast<double>(options.photons)),
        shifts_(key, Purpose::scrambling, first + 1) {}  // index 0 scrambles points of more dimensions

  void draw(std::uint64_t first, std::span<double> numbers) {
    if (sampler_ == Sampler::random) return random_.draw(first, std::array{numbers});
    for (double& number : numbers) number = shifts_.uniform();
    stratify(static_cast<double>(first), step_, numbers.data(), numbers.size());
  }

 private:
  Sampler sampler_;
  EmissionNumbers random_;
  double step_;
  RandomStream shifts_;
};

}  // namespace

bool PlaneFlights::possible(const Scene& scene) {
  const NearField& field = scene.near_field;
  return PlaneScene::possible(scene) && field.shape() == NearField::Shape::disc &&
         field.center_mm().x() == 0 && field.center_mm().y() == 0 && field.normal().x() == 0 &&
         field.normal().y() == 0;
}

PlaneFlights::PlaneFlights(const Scene& scene, double reach_mm) {
  const double out_mm = scene.near_field.material() ? scene.near_field.half_width_mm() : reach_mm;
  parts_.reset(new Parts{PlaneScene(scene, {NearField::Shape::disc, out_mm, out_mm}), emission_of(scene)});
}
PlaneFlights::~PlaneFlights() = default;

FlightTotals PlaneFlights::fly(const PhotonOptions& options, bool front, const TakeSquares& take) const {
  check(options);
  const std::uint64_t key = photon_key(options.seed, options.stream), photons = options.photons;
  SharedCounts counts;
  side_by_side(PhotonFlights::chunks(photons), [&](std::uint64_t i) {
    give_up_if_stopped(options);
    const std::uint64_t first = i * photons_of_a_chunk;
    const auto count = static_cast<std::size_t>(std::min(photons_of_a_chunk, photons - first));
    static constexpr auto ones = filled_with(1), zeros = filled_with(0);
    std::array<double, photons_of_a_chunk> numbers, cosines;
    const auto row = [count](auto& array) { return std::span(array.data(), count); };
    FirstNumbers(options, key, first).draw(first, row(numbers));
    parts_->emission->directions()->cosines(row(numbers), row(cosines));
    PlaneTracer tracer(parts_->scene, options.most_interactions, key);
    tracer.trace(first, {row(cosines), row(ones), row(zeros)});
    counts.add(tracer.counts());
    std::vector<double> squares;
    squares.reserve(tracer.crossings().size());
    for (const Crossing& crossing : tracer.crossings())
      if (crossing.from_front() == front) squares.push_back(crossing.plane_mm().squaredNorm());
    take(i, squares);
  });
  return counts.totals(photons, parts_->emission->power_w(), first_share(parts_->scene.scene));
}

}  // namespace catoptric::sim
