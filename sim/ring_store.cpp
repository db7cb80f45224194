#include "sim/ring_store.h"

#include <algorithm>

#include "sim/side_by_side.h"

namespace catoptric::sim {

std::size_t RingStore::segment_of(double s) const {
  const auto after = std::upper_bound(cuts_.begin() + 1, cuts_.end() - 1, s);
  return static_cast<std::size_t>(after - cuts_.begin()) - 1;
}

SortedRings::SortedRings(std::vector<double> cuts, std::size_t sets, std::span<const std::uint64_t> chunks)
    : RingStore(std::move(cuts), sets), squares_(sets) {
  for (std::uint64_t count : chunks) parts_.emplace_back(count);
}

void SortedRings::add(std::size_t set, std::uint64_t chunk, std::span<const double> squares) {
  std::vector<double>& part = parts_[set][chunk];
  for (double s : squares)
    if (s <= end()) part.push_back(s);
}

void SortedRings::close() {
  for (std::size_t set = 0; set < sets_; ++set) {
    for (auto& part : parts_[set]) squares_[set].insert(squares_[set].end(), part.begin(), part.end());
    std::sort(squares_[set].begin(), squares_[set].end());
  }
  parts_.clear();
}

double SortedRings::least_bandwidth() const {
  // Below the distance of a handful of photons an estimate is noise alone.
  std::size_t photons = 0;
  for (const auto& set : squares_) photons += set.size();
  return end() * std::min(1.0, 4.0 / static_cast<double>(std::max<std::size_t>(photons, 1)));
}

std::size_t SortedRings::memory_bytes() const {
  std::size_t photons = 0;
  for (const auto& set : squares_) photons += set.capacity();
  return photons * sizeof(double);
}

void SortedRings::estimate(std::span<const double> places, RingKernel kernel, double bandwidth,
                           const TakeDensity& take) const {
  constexpr std::size_t chunk = 64;
  side_by_side((places.size() + chunk - 1) / chunk, [&](std::size_t part) {
    RingDensity density;
    for (std::size_t i = part * chunk; i < std::min(places.size(), (part + 1) * chunk); ++i) {
      look(places[i], kernel, bandwidth, density);
      take(i, density);
    }
  });
}

void SortedRings::look(double s, RingKernel kernel, double bandwidth, RingDensity& out) const {
  out.second_order.assign(sets_, 0.0);
  out.fourth_order.assign(sets_, 0.0);
  out.second_square = out.fourth_square = 0;
  const std::size_t segment = segment_of(s);
  const double low = cuts_[segment], high = cuts_[segment + 1], h = std::min(bandwidth, high - low);
  const double from = std::max(low, s - h), to = std::min(high, s + h);
  const RingMoments moments = moments_between(kernel, (from - s) / h, (to - s) / h);
  const BoundaryPolynomial second = boundary_polynomial(moments, 2), fourth = boundary_polynomial(moments, 4);
  const double scale = 1 / h;
  for (std::size_t set = 0; set < sets_; ++set) {
    const auto& all = squares_[set];
    // A photon on a cut belongs to the segment above it.
    auto photon = std::lower_bound(all.begin(), all.end(), from);
    for (; photon != all.end() && (*photon < to || to == end()) && *photon <= to; ++photon) {
      const double u = (*photon - s) * scale, weight = scale * ring_kernel(kernel, u);
      const double w2 = weight * second(u), w4 = weight * fourth(u);
      out.second_order[set] += w2;
      out.fourth_order[set] += w4;
      out.second_square += w2 * w2;
      out.fourth_square += w4 * w4;
    }
  }
}

RingStore::Places SortedRings::places(std::size_t set, double) const {
  return {squares_[set], std::vector<double>(squares_[set].size(), 1.0)};
}

}  // namespace catoptric::sim
