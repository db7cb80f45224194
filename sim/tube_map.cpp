#include "sim/tube_map.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/units.h"
#include "sim/radius_bins.h"
#include "sim/tube_kernel.h"

namespace catoptric::sim {
namespace {

/// Rays next to a break start this far inside: some ten roundings of an angle. The light left out, power / 2
/// times this, is below the rounding of the field.
constexpr double step_inside_rad = 1e-14;

/// What one division of an interval may need: an edge's halvings, and three rays for each of its sides.
constexpr int most_halvings = 8, rays_a_division = most_halvings + 6;

/// Rays nearer than this are not told apart: the middle between them is at the rounding of their angles.
constexpr double least_width_rad = 8e-15;

struct Node {
  double theta_rad;
  std::size_t first, count;  ///< landings
  Dropped dropped;
};

/// Emission angles between two rays, with the rays at the quarters. An edge has none: the paths of its two
/// rays differ.
struct Interval {
  std::array<std::size_t, 5> nodes;
  double error = 0;
  bool is_edge = false;
  std::size_t low() const { return nodes[0]; }
  std::size_t high() const { return nodes[4]; }
};

class TubeMaker {
 public:
  TubeMaker(const TubeTracer& tracer, const AxialLight& light, const TubeGoal& goal)
      : tracer_(tracer), light_(light), goal_(goal), h_(goal.kernel_radius_mm), bins_(goal.r_max_mm) {}

  TubeMap make(const std::vector<double>& breaks) {
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i)
      start(breaks[i] + step_inside_rad, breaks[i + 1] - step_inside_rad);
    while (!open_.empty() && map_.rays + rays_a_division <= goal_.most_rays &&
           meetings_ <= goal_.most_meetings) {
      std::pop_heap(open_.begin(), open_.end(), smaller);
      const Interval interval = open_.back();
      open_.pop_back();
      if (!worth_halving(interval)) {
        done_.push_back(interval);
        continue;
      }
      book(interval, -1);
      divide(interval);
    }
    done_.insert(done_.end(), open_.begin(), open_.end());
    finish();
    return std::move(map_);
  }

 private:
  /// Initial tubes of one smooth piece: so narrow that what else the light may meet is rarely missed, so few
  /// that a smooth mirror costs no more than it needs.
  static constexpr std::size_t first_intervals = 4;

  std::size_t trace(double theta_rad) {
    const std::size_t first = landings_.size();
    const Dropped dropped = tracer_.trace(theta_rad, landings_);
    ++map_.rays;
    meetings_ += dropped.interactions;
    nodes_.push_back({theta_rad, first, landings_.size() - first, dropped});
    return nodes_.size() - 1;
  }

  static bool smaller(const Interval& a, const Interval& b) { return a.error < b.error; }

  double theta(std::size_t node) const { return nodes_[node].theta_rad; }
  std::size_t trace_between(std::size_t a, std::size_t b) { return trace(0.5 * (theta(a) + theta(b))); }

  void open(Interval interval) {
    book(interval, 1);
    open_.push_back(interval);
    std::push_heap(open_.begin(), open_.end(), smaller);
  }

  void open(std::size_t low, std::size_t middle, std::size_t high) {
    open({{low, trace_between(low, middle), middle, trace_between(middle, high), high}});
  }

  void divide(const Interval& interval) {
    const auto& nodes = interval.nodes;
    if (interval.is_edge) return divide_edge(interval.low(), interval.high());
    if (one_path(interval)) {
      open(nodes[0], nodes[1], nodes[2]);
      return open(nodes[2], nodes[3], nodes[4]);
    }
    std::size_t run = 0;  // the first ray of those that take one path
    for (std::size_t i = 0; i < 4; ++i) {
      if (same_paths(nodes[i], nodes[i + 1])) continue;
      open_side(nodes[run], nodes[i]);
      open_edge(nodes[i], nodes[i + 1]);
      run = i + 1;
    }
    open_side(nodes[run], nodes[4]);
  }

  /// Bisects between two rays whose paths differ, as long as there seems to be one edge between them and for
  /// some halvings; what lies on its sides goes on alone.
  void divide_edge(std::size_t first, std::size_t last) {
    std::size_t low = first, high = last, inside = last;
    for (int i = 0; i < most_halvings && theta(high) - theta(low) > 2 * least_width_rad; ++i) {
      const std::size_t middle = trace_between(low, high);
      const bool below = same_paths(low, middle), above = same_paths(middle, high);
      if (!below && !above) {
        inside = middle;
        break;
      }
      (below ? low : high) = middle;
    }
    open_side(first, low);
    if (inside != last) open_edge(low, inside);
    open_edge(inside != last ? inside : low, high);
    open_side(high, last);
  }

  void open_edge(std::size_t low, std::size_t high) {
    Interval edge{{low, low, high, high, high}};
    edge.is_edge = true;
    open(edge);
  }

  void open_side(std::size_t low, std::size_t high) {
    if (low == high) return;
    if (!same_paths(low, high)) return open_edge(low, high);
    open(low, trace_between(low, high), high);
  }

  void start(double low_rad, double high_rad) {
    if (!(high_rad - low_rad > 4 * step_inside_rad)) return;
    const std::size_t low = trace(low_rad), high = trace(high_rad), middle = trace_between(low, high);
    bool touched = false;
    for (const std::size_t node : {low, middle, high})
      touched = touched || nodes_[node].dropped.interactions > 0;
    if (!touched) return;
    std::array<std::size_t, first_intervals + 1> ends;
    for (std::size_t i = 0; i <= first_intervals; ++i)
      ends[i] = i == 0                     ? low
                : i == first_intervals     ? high
                : 2 * i == first_intervals ? middle
                                           : trace(low_rad + (high_rad - low_rad) * static_cast<double>(i) /
                                                                 static_cast<double>(first_intervals));
    for (std::size_t i = 0; i < first_intervals; ++i)
      open(ends[i], trace_between(ends[i], ends[i + 1]), ends[i + 1]);
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

  double flux_between(std::size_t low, std::size_t high) const {
    return light_.power_w * light_.share(theta(low), theta(high));
  }

  double width(const Interval& interval) const { return theta(interval.high()) - theta(interval.low()); }

  bool one_path(const Interval& interval) const {
    if (interval.is_edge) return false;
    for (std::size_t i = 0; i < 4; ++i)
      if (!same_paths(interval.nodes[i], interval.nodes[i + 1])) return false;
    return true;
  }

  /// Adds the interval's error, times `sign`, to the bins of radii it can reach, and notes its largest.
  void book(Interval& interval, double sign) {
    const double flux_w = flux_between(interval.low(), interval.high());
    double everywhere = 0, faint = 0;
    interval.error = 0;
    for (const std::size_t node : interval.nodes) faint = std::max(faint, nodes_[node].dropped.faint);
    if (one_path(interval)) {
      for (std::size_t i = 0; i < nodes_[interval.low()].count; ++i) book_landing(interval, i, flux_w, sign);
    } else {
      double most = 0;
      for (const std::size_t node : interval.nodes) most = std::max(most, weight(node));
      everywhere += h_ > 0 ? flux_w * most * kernel_peak_per_mm2(h_) : width(interval);
    }
    interval.error = std::max(interval.error, everywhere);
    if (h_ > 0) everywhere += flux_w * faint * kernel_peak_per_mm2(h_);  // which no halving mends
    if (everywhere > 0) bins_.add_everywhere(sign * everywhere);
  }
  void book(const Interval& interval, double sign) {
    Interval copy = interval;
    book(copy, sign);
  }

  Hermite hermite(std::size_t low, std::size_t middle, std::size_t high, std::size_t i) const {
    const Landing &a = landing(low, i), &m = landing(middle, i), &b = landing(high, i);
    const double half = 0.5 * (theta(high) - theta(low));
    return {a.rho_mm,
            m.rho_mm,
            b.rho_mm,
            half * a.slope_mm_per_rad,
            half * m.slope_mm_per_rad,
            half * b.slope_mm_per_rad};
  }

  /// How far the quintic of an interval's ends and middle is off at the quarters, radius and derivative by x,
  /// and the parabola of the weights.
  struct Misfit {
    double mm = 0, slope = 0, weight = 0;
  };
  Misfit misfit(const Interval& interval, std::size_t i) const {
    Tube whole;
    hermite(interval.nodes[0], interval.nodes[2], interval.nodes[4], i).quintic(whole.rho);
    Misfit worst;
    const double low = landing(interval.nodes[0], i).weight, middle = landing(interval.nodes[2], i).weight,
                 high = landing(interval.nodes[4], i).weight;
    for (const auto& [node, x] : {std::pair{interval.nodes[1], -0.5}, {interval.nodes[3], 0.5}}) {
      const Landing& ray = landing(node, i);
      worst.mm = std::max(worst.mm, std::abs(whole.at(x) - ray.rho_mm));
      worst.slope =
          std::max(worst.slope, std::abs(whole.slope(x) - 0.5 * width(interval) * ray.slope_mm_per_rad));
      const double parabola =
          middle + x * (0.5 * (high - low) + x * (0.5 * (high - middle) - 0.5 * (middle - low)));
      worst.weight = std::max(worst.weight, std::abs(parabola - ray.weight));
    }
    return worst;
  }
  /// The two tubes of half the width are off by a sixty-fourth of the whole's misfit; counted four times.
  static constexpr double counted = 1.0 / 16;

  void book_landing(Interval& interval, std::size_t i, double flux_w, double sign) {
    const Misfit fit = misfit(interval, i);
    // The derivative's misfit is at most 1.3 times the radius's, unless the sixth derivative is not all.
    const double off = fit.mm + 0.25 * fit.slope;
    double least = HUGE_VAL, most = -HUGE_VAL, heaviest = 0;
    bool rises = true, falls = true;
    for (const std::size_t node : interval.nodes) {
      const Landing& ray = landing(node, i);
      least = std::min(least, ray.rho_mm);
      most = std::max(most, ray.rho_mm);
      heaviest = std::max(heaviest, ray.weight);
      rises = rises && ray.slope_mm_per_rad > 0;
      falls = falls && ray.slope_mm_per_rad < 0;
    }
    const double inner = least < 0 && most > 0 ? 0 : std::min(std::abs(least), std::abs(most));
    const double outer = std::max(std::abs(least), std::abs(most));
    // Room for what the light may do beyond its rays.
    const double reach = h_ + off + 0.25 * (most - least);
    if (inner - reach > goal_.r_max_mm) return;
    double error;
    if (h_ > 0) {
      constexpr double steepest = 4.6188021535170061;  // of 3 (1 - t^2)^2: 16 / (2 sqrt 3), at t^2 = 1/3
      const double share = ring_share(std::max(0.0, inner - off), h_);
      const double peak = kernel_peak_per_mm2(h_);
      error = heaviest * flux_w * share * std::min(peak, steepest / (pi * h_ * h_ * h_) * off * counted) +
              fit.weight * weight_misfit_counted * flux_w * share * peak;
    } else {
      // The pointwise field polishes with rays of its own; it needs the tubes only to find each branch:
      // within 1e-3 of the tube, or of the part's rounding where branches meet in a fold.
      const double allowed =
          rises || falls ? 1e-3 * (most - least) + 1e-12 * goal_.r_max_mm : 1e-10 * goal_.r_max_mm;
      error = off > allowed ? width(interval) : 0;
    }
    interval.error = std::max(interval.error, error);
    bins_.add(inner - reach, outer + reach, sign * error);
  }

  bool worth_halving(const Interval& interval) const {
    if (!(interval.error > 0) || width(interval) < 4 * least_width_rad) return false;
    if (h_ <= 0) return true;
    // Thousands of these would not matter, so what is still too much cannot be mended by rays.
    if (interval.error < 1e-4 * goal_.tolerance_w_per_mm2) return false;
    return bins_.worst() > goal_.tolerance_w_per_mm2;
  }

  void finish() {
    std::sort(done_.begin(), done_.end(),
              [&](const Interval& a, const Interval& b) { return theta(a.low()) < theta(b.low()); });
    bins_.clear();
    for (const Interval& interval : done_) {
      book(interval, 1);
      map_.cut_off_w +=
          flux_between(interval.low(), interval.high()) * nodes_[interval.nodes[2]].dropped.cut_off;
      if (one_path(interval))
        emit(interval);
      else
        emit_pairs(interval);
    }
    if (h_ > 0) map_.error_w_per_mm2 = bins_.worst();
  }

  void emit(const Interval& interval) {
    const auto& nodes = interval.nodes;
    for (std::size_t i = 0; i < nodes_[interval.low()].count; ++i) {
      const Misfit fit = misfit(interval, i);
      for (const std::size_t first : {0, 2})
        emit(nodes[first], nodes[first + 2], i, hermite(nodes[first], nodes[first + 1], nodes[first + 2], i),
             {counted * fit.mm, counted * fit.slope, weight_misfit_counted * fit.weight},
             landing(nodes[first + 1], i).weight);
    }
  }

  /// Where rays did not suffice: what the neighbours on one path tell, all of which the error counts.
  void emit_pairs(const Interval& interval) {
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t low = interval.nodes[k], high = interval.nodes[k + 1];
      if (low == high || !same_paths(low, high)) continue;
      for (std::size_t i = 0; i < nodes_[low].count; ++i) {
        Hermite ends = hermite(low, low, high, i);
        ends.middle = 0.5 * (ends.first + ends.last) + 0.25 * (ends.d_first - ends.d_last);
        ends.d_middle = 0.75 * (ends.last - ends.first) - 0.25 * (ends.d_first + ends.d_last);
        const double first = landing(low, i).weight, last = landing(high, i).weight;
        emit(low, high, i, ends, {HUGE_VAL, HUGE_VAL, std::max(first, last)}, 0.5 * (first + last));
      }
    }
  }

  void emit(std::size_t low, std::size_t high, std::size_t i, const Hermite& through, const Misfit& off,
            double middle_weight) {
    const Landing &first = landing(low, i), &last = landing(high, i);
    const WeightCourse course = WeightCourse::through(first.weight, middle_weight, last.weight, off.weight);
    map_.landed_w += flux_between(low, high) *
                     (course.level ? first.weight : (first.weight + 4 * middle_weight + last.weight) / 6);
    const double heaviest = std::max({first.weight, middle_weight, last.weight});
    Tube tube{theta(low), theta(high), {},       first.rho_mm, last.rho_mm,
              off.mm,     off.slope,   heaviest, first.path,   course};
    through.quintic(tube.rho);
    map_.tubes.push_back(tube);
  }

  const TubeTracer& tracer_;
  AxialLight light_;
  TubeGoal goal_;
  double h_;
  long meetings_ = 0;  ///< of all rays with the mirror
  TubeMap map_;
  std::vector<Landing> landings_;
  std::vector<Node> nodes_;
  std::vector<Interval> open_, done_;
  RadiusBins bins_;
};

double polar_angle(const MeridianPoint& point, double source_z_mm) {
  return std::atan2(std::max(0.0, point.r_mm), point.z_mm - source_z_mm);
}

}  // namespace

TubeMap make_tubes(const TubeTracer& tracer, const std::vector<double>& breaks, const AxialLight& light,
                   const TubeGoal& goal) {
  return TubeMaker(tracer, light, goal).make(breaks);
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
