#pragma once

#include <array>
#include <vector>

#include "cad/meridian_blocks.h"
#include "cad/meridian_crossing.h"
#include "cad/meridian_lane_pair.h"

namespace catoptric::cad::meridian {

/// Four rays side by side.
struct RayGroup {
  AxisLine<Lanes> line;
  Lanes shift;  ///< distance along the given ray = shift + t
  Culler<Lanes> culler;
  CrossingFactors<Lanes> factors;
  Mask open;   ///< rays to be answered here
  Mask alone;  ///< rays left to be done alone
};

inline constexpr std::size_t jobs_at_once = 2 * lane_count;

/// Pieces that a ray each certainly crosses once.
struct CrossingJobs {
  std::array<PairArray, most_coefficients> f;  ///< of CrossingGuess
  PairArray from;                              ///< of Crossings
  std::array<const FastPiece*, jobs_at_once> piece;
  std::array<std::size_t, jobs_at_once> ray;
};

/// Such jobs in the order in which they are found.
class JobList {
 public:
  void clear() { size_ = 0; }
  std::size_t size() const { return size_; }
  const CrossingJobs* data() const { return jobs_.data(); }

  /// Of ray `ray`, whose coefficients are in lane `lane`.
  CATOPTRIC_FORCE_INLINE void add(const Crossings& crossings, std::size_t count, std::size_t lane,
                                  const FastPiece& piece, std::size_t ray) {
    if (size_ == jobs_.size() * jobs_at_once) jobs_.resize(2 * jobs_.size() + 1);
    CrossingJobs& jobs = jobs_[size_ / jobs_at_once];
    const std::size_t k = size_++ % jobs_at_once;
    for (std::size_t i = 0; i < count; ++i) jobs.f[i][k] = crossings.f[i][lane];
    jobs.from[k] = crossings.from[lane];
    jobs.piece[k] = &piece;
    jobs.ray[k] = ray;
  }
  /// Takes back the last jobs, but none before `first`, as long as they are farther along their ray than t.
  void drop_beyond(double t, std::size_t first) {
    while (size_ > first && jobs_[(size_ - 1) / jobs_at_once].from[(size_ - 1) % jobs_at_once] > t) --size_;
  }
  /// Fills the last jobs up with copies of one of them, so that all lanes have a crossing to find.
  void fill_up() {
    const std::size_t used = size_ % jobs_at_once;
    if (used == 0) return;
    CrossingJobs& jobs = jobs_[size_ / jobs_at_once];
    for (std::size_t k = used; k < jobs_at_once; ++k) {
      for (PairArray& numbers : jobs.f) numbers[k] = numbers[0];
      jobs.piece[k] = jobs.piece[0];
      jobs.ray[k] = jobs.ray[0];
    }
  }

 private:
  std::vector<CrossingJobs> jobs_;
  std::size_t size_ = 0;
};

/// The nearest hits so far.
struct NearestHits {
  std::vector<double> t, s, r, z;
  std::vector<const SpanForm*> span;
};

}  // namespace catoptric::cad::meridian
