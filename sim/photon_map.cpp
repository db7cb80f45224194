#include "sim/photon_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/tolerance.h"
#include "base/units.h"
#include "sim/edge_correction.h"
#include "sim/kernel_sum.h"
#include "sim/ladder_sum.h"
#include "sim/photon_grid.h"
#include "sim/side_by_side.h"

namespace catoptric::sim {
namespace {

/// The photons of one side of the plane: a grid for each band of the recorded area.
class Side {
 public:
  Side() : grids_(photon_bands) {}

  /// Takes a band's photons out of the chunks, in their order.
  void build(std::size_t band, std::vector<StoredChunk>& chunks, BandedPhotons StoredChunk::*side) {
    build(band, band + 1, chunks, side);
  }

  /// Takes all photons into one grid.
  void build(std::vector<StoredChunk>& chunks, BandedPhotons StoredChunk::*side) {
    build(0, photon_bands, chunks, side);
    grids_.resize(1);
  }

  /// To be called once all bands are built.
  void close() {
    for (const PhotonGrid& grid : grids_) size_ += grid.size();
  }

  std::size_t size() const { return size_; }

  void add_within(const StoredPhoton& centre, double radius_mm, KernelSum& sum) const {
    for (const PhotonGrid& grid : grids_) grid.add_within(centre, radius_mm, sum);
  }

  void add_within(const StoredPhoton& centre, double radius_mm, LadderSum& sum) const {
    for (const PhotonGrid& grid : grids_) grid.add_within(centre, radius_mm, sum);
  }

  void append_every(std::size_t stride, std::vector<StoredPhoton>& photons) const {
    for (const PhotonGrid& grid : grids_)
      grid.take_every(stride, [&](const StoredPhoton& photon) { photons.push_back(photon); });
  }

  /// Squared distances of the nearest `count` photons, at most all of them; nearest are not sorted.
  /// @in  first_mm: where to start looking for the radius that holds them, any length > 0
  void nearest(const StoredPhoton& centre, std::size_t count, double first_mm,
               std::vector<double>& squares) const {
    squares.clear();
    const double radius = count < size() ? radius_with(centre, count, first_mm) : HUGE_VAL;
    for (const PhotonGrid& grid : grids_) grid.append_squares(centre, radius, squares);
    if (squares.size() <= count) return;
    std::nth_element(squares.begin(), squares.begin() + static_cast<std::ptrdiff_t>(count - 1),
                     squares.end());
    squares.resize(count);
  }

 private:
  void build(std::size_t first, std::size_t end, std::vector<StoredChunk>& chunks,
             BandedPhotons StoredChunk::*side) {
    std::vector<std::vector<StoredPhoton>*> stretches;
    stretches.reserve((end - first) * chunks.size());
    for (std::size_t band = first; band < end; ++band)
      for (StoredChunk& chunk : chunks) stretches.push_back(&(chunk.*side)[band]);
    grids_[first] = PhotonGrid(std::move(stretches));
  }

  /// A radius that holds at least `count` photons, and not many more where they lie evenly.
  double radius_with(const StoredPhoton& centre, std::size_t count, double first_mm) const {
    const auto holds = [&](double radius) {
      std::size_t within = 0;
      for (const PhotonGrid& grid : grids_) within += grid.surely_within(centre, radius);
      return within >= count;
    };
    constexpr double step = 1.25;  // in area by half: what is then looked at in vain
    double radius = first_mm;
    while (!holds(radius) && radius < HUGE_VAL) radius *= step;
    while (radius > first_mm * least_share && holds(radius / step)) radius /= step;
    return radius;
  }

  static constexpr double least_share = 1e-12;  // below that all photons are in one point
  std::vector<PhotonGrid> grids_;
  std::size_t size_ = 0;
};

}  // namespace

void check(const EstimateOptions& options) {
  if (options.neighbours.has_value() == options.kernel_radius_mm.has_value())
    throw InputError({options.neighbours ? "both neighbours and kernel radius are set"
                                         : "neither neighbours nor kernel radius is set",
                      "estimate", "exactly one of them sets the bandwidth", "leave one of them out"});
  if (options.neighbours && *options.neighbours == 0)
    throw InputError({"0 neighbours", "estimate", "an estimate needs at least one photon", "500 is usual"});
  if (options.kernel_radius_mm &&
      !(std::isfinite(*options.kernel_radius_mm) && *options.kernel_radius_mm > 0))
    throw InputError({fmt::format("kernel radius of {} mm", *options.kernel_radius_mm), "estimate",
                      "a radius is finite and greater than 0", "a tenth of the field's size is usual"});
}

double recording_margin_mm(const NearField& field, const EstimateOptions& options) {
  return options.kernel_radius_mm ? *options.kernel_radius_mm
                                  : std::max(field.half_width_mm(), field.half_height_mm());
}

struct PhotonMap::Parts {
  NearField field;
  RecordedArea area;
  double photon_power_w;
  double least_radius_mm;  ///< a bandwidth below this would be a division by nothing
  Side front = {}, back = {};

  const Side& side_of(const FieldSample& sample) const { return field.looks_to_front(sample) ? front : back; }

  void build(std::vector<StoredChunk> chunks) {
    // Bands spare memory and are built side by side; of few photons they only make estimates dearer.
    constexpr std::size_t few_chunks = 16;
    if (chunks.size() <= few_chunks) {
      front.build(chunks, &StoredChunk::front);
      back.build(chunks, &StoredChunk::back);
    } else {
      side_by_side(2 * photon_bands, [&](std::size_t i) {
        if (i < photon_bands)
          front.build(i, chunks, &StoredChunk::front);
        else
          back.build(i - photon_bands, chunks, &StoredChunk::back);
      });
    }
    front.close();
    back.close();
  }

  /// Sums the kernel over the photons round a point and gives the bandwidth; `squares` is room to work in.
  KernelSum gather(const Side& side, const StoredPhoton& at, const EstimateOptions& options,
                   std::vector<double>& squares, double& radius_mm) const {
    if (options.kernel_radius_mm) {
      radius_mm = *options.kernel_radius_mm;
      KernelSum sum(options.kernel, at.x_mm, at.y_mm, radius_mm);
      side.add_within(at, radius_mm, sum);
      return sum;
    }
    const std::size_t count = std::min(*options.neighbours, side.size());
    side.nearest(at, count, expected_radius_mm(count, side.size()), squares);
    const double farthest = squares.empty() ? 0 : *std::max_element(squares.begin(), squares.end());
    radius_mm = squares.empty() ? 0 : std::max(least_radius_mm, std::sqrt(farthest));
    KernelSum sum(options.kernel, at.x_mm, at.y_mm, radius_mm);
    if (!squares.empty()) sum.add_squares(squares.data(), squares.size());
    return sum;
  }

  /// The radius that holds so many photons when they lie evenly on the recorded area.
  double expected_radius_mm(std::size_t count, std::size_t size) const {
    const double share = static_cast<double>(std::max<std::size_t>(count, 1)) /
                         static_cast<double>(std::max<std::size_t>(size, 1));
    return std::sqrt(share * area.half_width_mm) * std::sqrt(area.half_height_mm);
  }
};

PhotonMap::PhotonMap(const NearField& field, TracedPhotons traced)
    : parts_(new Parts{
          field, traced.area, traced.photon_power_w,
          Tolerance::for_scale(std::hypot(field.half_width_mm(), field.half_height_mm())).length_mm}) {
  parts_->build(std::move(traced.chunks));
}
PhotonMap::~PhotonMap() = default;
PhotonMap::PhotonMap(PhotonMap&&) noexcept = default;
PhotonMap& PhotonMap::operator=(PhotonMap&&) noexcept = default;

std::size_t PhotonMap::size(const Vector3& normal) const {
  return (normal.dot(parts_->field.normal()) > 0 ? parts_->front : parts_->back).size();
}

MapEstimate PhotonMap::estimate(std::span<const FieldSample> samples, const EstimateOptions& options) const {
  check(options);
  MapEstimate out{std::vector<double>(samples.size()), std::vector<double>(samples.size()),
                  std::vector<double>(samples.size()), std::vector<std::size_t>(samples.size())};
  const auto estimate_one = [&](std::size_t i, std::vector<double>& squares) {
    const Vector2 at = parts_->field.to_plane(samples[i].point_mm);
    double radius = 0;
    const KernelSum sum =
        parts_->gather(parts_->side_of(samples[i]), {at.x(), at.y()}, options, squares, radius);
    out.kernel_radius_mm[i] = radius;
    out.photons[i] = sum.photons();
    if (out.photons[i] == 0) return;
    const double scale = parts_->photon_power_w / (pi * radius * radius) /
                         kernel_mass_inside(options.kernel, radius, parts_->area, at);
    out.irradiance[i] = scale * sum.weight();
    out.noise[i] = scale * std::sqrt(sum.weight_squared());
  };
  constexpr std::size_t chunk = 16;
  side_by_side((samples.size() + chunk - 1) / chunk, [&](std::size_t part) {
    std::vector<double> squares;
    for (std::size_t i = part * chunk; i < std::min(samples.size(), (part + 1) * chunk); ++i)
      estimate_one(i, squares);
  });
  return out;
}

std::vector<StoredPhoton> PhotonMap::some(std::size_t wanted) const {
  const std::size_t stride = std::max<std::size_t>(
      1, (parts_->front.size() + parts_->back.size()) / std::max<std::size_t>(1, wanted));
  std::vector<StoredPhoton> photons;
  parts_->front.append_every(stride, photons);
  parts_->back.append_every(stride, photons);
  return photons;
}

std::vector<std::vector<double>> PhotonMap::ladder(std::span<const FieldSample> samples,
                                                   double widest_radius_mm, std::size_t levels) const {
  std::vector<std::vector<double>> fields(levels, std::vector<double>(samples.size()));
  std::vector<double> radii(levels);
  for (std::size_t level = 0; level < levels; ++level)
    radii[level] = widest_radius_mm * std::pow(0.5, 0.5 * static_cast<double>(level));
  constexpr std::size_t chunk = 16;
  side_by_side((samples.size() + chunk - 1) / chunk, [&](std::size_t part) {
    LadderSum sum(widest_radius_mm, levels);
    std::vector<double> weights(levels);
    for (std::size_t i = part * chunk; i < std::min(samples.size(), (part + 1) * chunk); ++i) {
      const Vector2 at = parts_->field.to_plane(samples[i].point_mm);
      sum.start({at.x(), at.y()});
      parts_->side_of(samples[i]).add_within({at.x(), at.y()}, widest_radius_mm, sum);
      sum.weights(weights);
      for (std::size_t level = 0; level < levels; ++level)
        fields[level][i] = parts_->photon_power_w / (pi * radii[level] * radii[level]) * weights[level] /
                           kernel_mass_inside(Kernel::silverman, radii[level], parts_->area, at);
    }
  });
  return fields;
}

}  // namespace catoptric::sim
