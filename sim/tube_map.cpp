#include "sim/tube_map.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/units.h"
#include "sim/tube_kernel.h"

namespace catoptric::sim {
namespace {

/// Rays next to a break start this far inside: some ten roundings of an angle. The light left out, power / 2
/// times this, is below the rounding of the field.
constexpr double step_inside_rad = 1e-14;

/// Intervals narrower than this are not halved: their middle is at the rounding of its ends.
constexpr double least_width_rad = 8e-15;

struct Node {
  double theta_rad;
  std::size_t first, count;  ///< landings
  Dropped dropped;
};

/// Emission angles between two rays, with the ray in the middle.
struct Interval {
  std::size_t low, middle, high;  ///< nodes
  double error;
};

double flux_share(double low_rad, double high_rad) {
  // Half the difference of cosines, without their cancellation.
  return std::sin(0.5 * (low_rad + high_rad)) * std::sin(0.5 * (high_rad - low_rad));
}

class TubeMaker {
 public:
  TubeMaker(const TubeTracer& tracer, double power_w, const TubeGoal& goal)
      : tracer_(tracer), power_w_(power_w), goal_(goal), h_(goal.kernel_radius_mm) {}

  TubeMap make(const std::vector<double>& breaks) {
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i)
      start(breaks[i] + step_inside_rad, breaks[i + 1] - step_inside_rad);
    const auto smaller = [](const Interval& a, const Interval& b) { return a.error < b.error; };
    std::make_heap(open_.begin(), open_.end(), smaller);
    while (!open_.empty() && map_.rays + 2 <= goal_.most_rays) {
      std::pop_heap(open_.begin(), open_.end(), smaller);
      const Interval interval = open_.back();
      open_.pop_back();
      if (!worth_halving(interval)) {
        done_.push_back(interval);
        continue;
      }
      book(interval, -1);
      for (const auto& [low, high] :
           {std::pair{interval.low, interval.middle}, {interval.middle, interval.high}}) {
        open_.push_back(between(low, high));
        std::push_heap(open_.begin(), open_.end(), smaller);
      }
    }
    done_.insert(done_.end(), open_.begin(), open_.end());
    finish();
    return std::move(map_);
  }

 private:
  static constexpr std::size_t bins = 64;
  /// Initial tubes of one smooth piece: so narrow that what else the light may meet is rarely missed, so few
  /// that a smooth mirror costs no more than it needs.
  static constexpr int first_intervals = 8;

  std::size_t trace(double theta_rad) {
    const std::size_t first = landings_.size();
    const Dropped dropped = tracer_.trace(theta_rad, landings_);
    ++map_.rays;
    nodes_.push_back({theta_rad, first, landings_.size() - first, dropped});
    return nodes_.size() - 1;
  }

  Interval between(std::size_t low, std::size_t high) {
    const std::size_t middle = trace(0.5 * (nodes_[low].theta_rad + nodes_[high].theta_rad));
    Interval interval{low, middle, high, 0};
    book(interval, 1);
    return interval;
  }

  void start(double low_rad, double high_rad) {
    if (!(high_rad - low_rad > 4 * step_inside_rad)) return;
    const std::size_t low = trace(low_rad), high = trace(high_rad);
    const std::size_t middle = trace(0.5 * (low_rad + high_rad));
    bool touched = false;
    for (const std::size_t node : {low, middle, high})
      touched = touched || nodes_[node].dropped.interactions > 0;
    if (!touched) return;
    std::array<std::size_t, first_intervals + 1> ends;
    for (std::size_t i = 0; i <= first_intervals; ++i)
      ends[i] = i == 0                 ? low
                : i == first_intervals ? high
                : 2 * i == first_intervals
                    ? middle
                    : trace(low_rad + (high_rad - low_rad) * static_cast<double>(i) / first_intervals);
    for (std::size_t i = 0; i < first_intervals; ++i) open_.push_back(between(ends[i], ends[i + 1]));
  }

  const Landing& landing(std::size_t node, std::size_t i) const { return landings_[nodes_[node].first + i]; }

  bool same_paths(std::size_t a, std::size_t b) const {
    if (nodes_[a].count != nodes_[b].count) return false;
    for (std::size_t i = 0; i < nodes_[a].count; ++i)
      if (landing(a, i).path != landing(b, i).path) return false;
    return true;
  }

  double weight(std::size_t node) const {
    double sum = 0;
    for (std::size_t i = 0; i < nodes_[node].count; ++i) sum += landing(node, i).weight;
    return sum;
  }

  double width(const Interval& interval) const {
    return nodes_[interval.high].theta_rad - nodes_[interval.low].theta_rad;
  }

  /// Adds the interval's error, times `sign`, to the bins of radii it can reach, and notes its largest.
  void book(Interval& interval, double sign) {
    const Node &low = nodes_[interval.low], &high = nodes_[interval.high];
    const double flux_w = power_w_ * flux_share(low.theta_rad, high.theta_rad);
    const std::array<std::size_t, 3> nodes{interval.low, interval.middle, interval.high};
    double everywhere = 0, faint = 0;
    interval.error = 0;
    for (const std::size_t node : nodes) faint = std::max(faint, nodes_[node].dropped.faint);
    if (!same_paths(interval.low, interval.middle) || !same_paths(interval.middle, interval.high)) {
      double most = 0;
      for (const std::size_t node : nodes) most = std::max(most, weight(node));
      everywhere += h_ > 0 ? flux_w * most * kernel_peak_per_mm2(h_) : width(interval);
    } else {
      for (std::size_t i = 0; i < low.count; ++i) book_landing(interval, i, flux_w, sign);
    }
    interval.error = std::max(interval.error, everywhere);
    if (h_ > 0) everywhere += flux_w * faint * kernel_peak_per_mm2(h_);  // which no halving mends
    if (everywhere > 0) add(0, bins - 1, everywhere, sign);
  }
  void book(const Interval& interval, double sign) {
    Interval copy = interval;
    book(copy, sign);
  }

  void book_landing(Interval& interval, std::size_t i, double flux_w, double sign) {
    const Landing &a = landing(interval.low, i), &m = landing(interval.middle, i),
                  &b = landing(interval.high, i);
    const double step = width(interval);
    const double middle =
        0.5 * (a.rho_mm + b.rho_mm) + 0.125 * step * (a.slope_mm_per_rad - b.slope_mm_per_rad);
    const double slope =
        1.5 * (b.rho_mm - a.rho_mm) / step - 0.25 * (a.slope_mm_per_rad + b.slope_mm_per_rad);
    const double off = std::abs(middle - m.rho_mm) + std::abs(slope - m.slope_mm_per_rad) * step / 16;
    auto [least, most] = std::minmax({a.rho_mm, m.rho_mm, b.rho_mm});
    const double inner = least < 0 && most > 0 ? 0 : std::min(std::abs(least), std::abs(most));
    const double outer = std::max(std::abs(least), std::abs(most));
    // Room for what the cubic may do beyond its rays.
    const double reach = h_ + off + 0.25 * (most - least);
    if (inner - reach > goal_.r_max_mm) return;
    double error;
    if (h_ > 0) {
      constexpr double steepest = 4.6188021535170061;  // of 3 (1 - t^2)^2: 16 / (2 sqrt 3), at t^2 = 1/3
      const double share = ring_share(std::max(0.0, inner - off), h_);
      error = m.weight * flux_w * share *
              std::min(kernel_peak_per_mm2(h_), steepest / (pi * h_ * h_ * h_) * off / 8);
    } else {
      const bool monotone =
          a.slope_mm_per_rad * m.slope_mm_per_rad > 0 && m.slope_mm_per_rad * b.slope_mm_per_rad > 0;
      // The pointwise field polishes with rays of its own; it needs the cubic only to find each branch:
      // within 1e-3 of the tube, or of the part's rounding where branches meet in a fold.
      const double allowed =
          monotone ? 1e-3 * (most - least) + 1e-12 * goal_.r_max_mm : 1e-10 * goal_.r_max_mm;
      error = off > allowed ? step : 0;
    }
    interval.error = std::max(interval.error, error);
    add(bin_of(inner - reach), bin_of(outer + reach), error, sign);
  }

  std::size_t bin_of(double r_mm) const {
    const double at = r_mm / goal_.r_max_mm * static_cast<double>(bins);
    return static_cast<std::size_t>(std::clamp(at, 0.0, static_cast<double>(bins - 1)));
  }

  void add(std::size_t first, std::size_t last, double error, double sign) {
    for (std::size_t i = first; i <= last; ++i) error_[i] += sign * error;
  }

  bool worth_halving(const Interval& interval) const {
    if (!(interval.error > 0) || width(interval) < 2 * least_width_rad) return false;
    if (h_ <= 0) return true;
    // Thousands of these would not matter, so what is still too much cannot be mended by rays.
    if (interval.error < 1e-4 * goal_.tolerance_w_per_mm2) return false;
    // The bins that hold too much, of which this is the largest part left.
    return std::any_of(error_.begin(), error_.end(),
                       [&](double error) { return error > goal_.tolerance_w_per_mm2; });
  }

  void finish() {
    std::sort(done_.begin(), done_.end(), [&](const Interval& a, const Interval& b) {
      return nodes_[a.low].theta_rad < nodes_[b.low].theta_rad;
    });
    error_.fill(0);
    for (const Interval& interval : done_) {
      book(interval, 1);
      const Node &low = nodes_[interval.low], &middle = nodes_[interval.middle],
                 &high = nodes_[interval.high];
      map_.cut_off_w += power_w_ * flux_share(low.theta_rad, high.theta_rad) * middle.dropped.cut_off;
      for (const auto& [a, b] : {std::pair{interval.low, interval.middle}, {interval.middle, interval.high}})
        if (same_paths(a, b)) emit(a, b);
    }
    if (h_ > 0) map_.error_w_per_mm2 = *std::max_element(error_.begin(), error_.end());
  }

  void emit(std::size_t low, std::size_t high) {
    const double first = nodes_[low].theta_rad, last = nodes_[high].theta_rad, step = last - first;
    for (std::size_t i = 0; i < nodes_[low].count; ++i) {
      const Landing &a = landing(low, i), &b = landing(high, i);
      const double rise = b.rho_mm - a.rho_mm, da = step * a.slope_mm_per_rad, db = step * b.slope_mm_per_rad;
      map_.landed_w += power_w_ * flux_share(first, last) * a.weight;
      map_.tubes.push_back({first,
                            last,
                            {a.rho_mm, da, 3 * rise - 2 * da - db, da + db - 2 * rise},
                            b.rho_mm,
                            a.weight,
                            a.path});
    }
  }

  const TubeTracer& tracer_;
  double power_w_;
  TubeGoal goal_;
  double h_;
  TubeMap map_;
  std::vector<Landing> landings_;
  std::vector<Node> nodes_;
  std::vector<Interval> open_, done_;
  std::array<double, bins> error_{};
};

double polar_angle(const MeridianPoint& point, double source_z_mm) {
  return std::atan2(std::max(0.0, point.r_mm), point.z_mm - source_z_mm);
}

}  // namespace

TubeMap make_tubes(const TubeTracer& tracer, const std::vector<double>& breaks, double power_w,
                   const TubeGoal& goal) {
  return TubeMaker(tracer, power_w, goal).make(breaks);
}

std::vector<double> emission_breaks(const Profile& profile, double source_z_mm) {
  std::vector<double> breaks{0, pi};
  const auto turning = [&](const MeridianPoint& p) { return (p.z_mm - source_z_mm) * p.dr - p.r_mm * p.dz; };
  for (const RationalSpan& span : profile.spans()) {
    // Outlines between these are found by the tubes themselves, at the price of more rays.
    constexpr int steps = 16;
    MeridianPoint before = evaluate(span, 0);
    breaks.push_back(polar_angle(before, source_z_mm));
    for (int i = 1; i <= steps; ++i) {
      double low = (i - 1.0) / steps, high = static_cast<double>(i) / steps;
      const MeridianPoint here = evaluate(span, high);
      const double sign = turning(before);
      before = here;
      if (!(sign * turning(here) < 0)) continue;
      // At the outline the angle is stationary: half the digits of s give all of the angle's.
      while (high - low > 1e-9) {
        const double middle = 0.5 * (low + high);
        (turning(evaluate(span, middle)) * sign > 0 ? low : high) = middle;
      }
      breaks.push_back(polar_angle(evaluate(span, 0.5 * (low + high)), source_z_mm));
    }
    breaks.push_back(polar_angle(before, source_z_mm));
  }
  std::sort(breaks.begin(), breaks.end());
  const auto same = [](double a, double b) { return b - a < 4 * step_inside_rad; };
  breaks.erase(std::unique(breaks.begin(), breaks.end(), same), breaks.end());
  if (pi - breaks.back() > 0) breaks.back() = pi;
  return breaks;
}

}  // namespace catoptric::sim
