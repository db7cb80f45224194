#include "base/profile_hull.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/bernstein.h"

namespace catoptric {
namespace {

struct Piece {
  std::vector<double> numerator, w;
  double upper() const {
    double most = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < w.size(); ++i) most = std::max(most, numerator[i] / w[i]);
    return most;
  }
  double value_at_ends() const {
    return std::max(numerator.front() / w.front(), numerator.back() / w.back());
  }
};

/// Branch and bound on the control polygon: pieces whose hull cannot beat the best point found are dropped.
double greatest(const std::vector<double>& numerator, const std::vector<double>& w) {
  std::vector<Piece> open{{numerator, w}};
  double best = open.front().value_at_ends();
  double scale = 0;
  for (std::size_t i = 0; i < w.size(); ++i) scale = std::max(scale, std::abs(numerator[i] / w[i]));
  const double slack = 4 * std::numeric_limits<double>::epsilon() * scale;
  for (int round = 0; round < 60 && !open.empty(); ++round) {
    std::vector<Piece> next;
    for (const Piece& piece : open) {
      if (piece.upper() <= best + slack) continue;
      Piece left, right;
      bernstein_split(piece.numerator, 0.5, left.numerator, right.numerator);
      bernstein_split(piece.w, 0.5, left.w, right.w);
      best = std::max({best, left.value_at_ends(), right.value_at_ends()});
      next.push_back(std::move(left));
      next.push_back(std::move(right));
    }
    open.clear();
    for (Piece& piece : next)
      if (piece.upper() > best + slack) open.push_back(std::move(piece));
  }
  return best;
}

Range range_of(const std::vector<double>& numerator, const std::vector<double>& w) {
  std::vector<double> negated(numerator);
  for (double& value : negated) value = -value;
  return {-greatest(negated, w), greatest(numerator, w)};
}

}  // namespace

Range range_of_r(const RationalSpan& span) { return range_of(span.rw, span.w); }
Range range_of_z(const RationalSpan& span) { return range_of(span.zw, span.w); }

std::vector<HullBox> hull_boxes(const Profile& profile, int halvings) {
  std::vector<HullBox> boxes;
  for (const RationalSpan& whole : profile.spans()) {
    std::vector<RationalSpan> pieces{whole};
    for (int level = 0; level < halvings; ++level) {
      std::vector<RationalSpan> halves;
      halves.reserve(2 * pieces.size());
      for (const RationalSpan& piece : pieces) {
        RationalSpan left, right;
        bernstein_split(piece.rw, 0.5, left.rw, right.rw);
        bernstein_split(piece.zw, 0.5, left.zw, right.zw);
        bernstein_split(piece.w, 0.5, left.w, right.w);
        const double middle = 0.5 * (piece.first + piece.last);
        left.first = piece.first;
        left.last = right.first = middle;
        right.last = piece.last;
        halves.push_back(std::move(left));
        halves.push_back(std::move(right));
      }
      pieces = std::move(halves);
    }
    for (const RationalSpan& piece : pieces) {
      HullBox box{HUGE_VAL, -HUGE_VAL, HUGE_VAL, -HUGE_VAL, piece.first, piece.last};
      for (std::size_t i = 0; i < piece.w.size(); ++i) {
        const double r = piece.rw[i] / piece.w[i], z = piece.zw[i] / piece.w[i];
        box.r_min_mm = std::min(box.r_min_mm, r);
        box.r_max_mm = std::max(box.r_max_mm, r);
        box.z_min_mm = std::min(box.z_min_mm, z);
        box.z_max_mm = std::max(box.z_max_mm, z);
      }
      boxes.push_back(box);
    }
  }
  return boxes;
}

}  // namespace catoptric
