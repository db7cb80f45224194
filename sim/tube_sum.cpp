#include "sim/tube_sum.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/units.h"
#include "sim/radial_panels.h"
#include "sim/sign_changes.h"
#include "sim/tube_halves.h"

namespace catoptric::sim {
namespace {

/// A stretch of a tube on which the landing radius only rises or only falls.
struct Stretch {
  double first, last;  ///< of x
  double rho_first, rho_last;
  double inner() const {
    return (rho_first < 0) != (rho_last < 0) ? 0 : std::min(std::abs(rho_first), std::abs(rho_last));
  }
  double outer() const { return std::max(std::abs(rho_first), std::abs(rho_last)); }
};

struct Stretches {
  std::array<Stretch, 5> part;
  std::size_t count = 0;
};

Stretches monotone_stretches(const Tube& tube) {
  std::array<double, 6> cuts{-1};
  std::size_t count = 1;
  std::array<double, 5> slope;
  double others = 0;
  for (std::size_t k = 0; k < 5; ++k) {
    slope[k] = static_cast<double>(k + 1) * tube.rho[k + 1];
    if (k > 0) others += std::abs(slope[k]);
  }
  if (!(others < std::abs(slope[0]))) {
    std::array<double, 4> turns;
    const std::size_t found = sign_changes<4>(slope, turns);
    for (std::size_t i = 0; i < found; ++i) cuts[count++] = turns[i];
  }
  cuts[count] = 1;
  Stretches stretches;
  for (std::size_t i = 0; i < count; ++i)
    stretches.part[stretches.count++] = {cuts[i], cuts[i + 1], i == 0 ? tube.begin_mm : tube.at(cuts[i]),
                                         i + 1 == count ? tube.end_mm : tube.at(cuts[i + 1])};
  return stretches;
}

/// Where the tube lands at `rho` on a stretch that passes it.
double place_of(const Tube& tube, const Stretch& stretch, double rho) {
  double low = stretch.first, high = stretch.last;
  const bool rises = stretch.rho_last > stretch.rho_first;
  double x = low + (high - low) * (rho - stretch.rho_first) / (stretch.rho_last - stretch.rho_first);
  // Newton squares what is left: after a step of this size the place is at its rounding.
  const double enough = 1e-9;
  for (int step = 0; step < 60; ++step) {
    const double off = tube.at(x) - rho;
    ((off < 0) == rises ? low : high) = x;
    double next = x - off / tube.slope(x);
    if (!(next >= low && next <= high)) next = 0.5 * (low + high);
    const double moved = std::abs(next - x);
    x = next;
    if (moved <= enough) break;
  }
  return x;
}

/// A tube that begins or ends with the light along the axis, which lands on the axis: there sin(theta) / rho
/// tends to 1 / slope, though both are lost in rounding.
struct AxialEnd {
  bool exists = false;
  double rho = 0;    ///< of the outermost ray, next to the axis
  double slope = 0;  ///< mm per radian
  double polar = 0;  ///< emission angle of the axis: 0 or pi
};

AxialEnd axial_end(const Tube& tube) {
  const double half = tube.half_width_rad();
  for (const AxialEnd& end : {AxialEnd{true, tube.begin_mm, tube.slope(-1) / half, 0},
                              AxialEnd{true, tube.end_mm, tube.slope(1) / half, pi}}) {
    const double off = end.polar > 0 ? pi - tube.last_rad : tube.first_rad;
    // The outermost ray leaves this near the axis, and lands where a straight continuation says.
    if (off < 2e-14 && std::abs(end.rho) <= 4 * std::abs(end.slope) * off) return end;
  }
  return {};
}

/// Irradiance of one branch: intensity sin(theta) / (rho |slope|).
double branch_irradiance(const AxialLight& light, double theta, double rho, double slope,
                         const AxialEnd& axis) {
  const double off = std::abs(theta - axis.polar);
  // Next to the axis rho is odd in the angle, so rho / off is (2 slope(0) + slope) / 3 to the fourth order:
  // 1e-12 here, where rho itself is worth 1e-13 of the part over 1e-3 of it.
  const double ratio = axis.exists && off < 1e-3
                           ? 3 * (off > 0 ? std::sin(off) / off : 1) / (2 * axis.slope + slope)
                           : std::sin(theta) / rho;
  const double even = light.power_w / (4 * pi) * std::abs(ratio / slope);
  return light.law.is_even() ? even : light.relative_at(theta) * even;
}

/// What a stretch of a tube gives without more rays, and how far that may be off.
class TubeIrradiance {
 public:
  TubeIrradiance(const Tube& tube, const Stretch& stretch, const AxialLight& light, const AxialEnd& axis)
      : tube_(tube), stretch_(stretch), light_(light), axis_(axis) {}

  /// Irradiance where the tube lands at `rho`; worst_error grows with it.
  double at(double rho) {
    const double x = place_of(tube_, stretch_, rho), half = tube_.half_width_rad();
    const double slope = tube_.slope(x), theta = tube_.theta_rad(x);
    const double full = tube_.weight * branch_irradiance(light_, theta, rho, slope / half, axis_);
    const WeightCourse& course = tube_.course;
    const double value = course.level ? full : full * course.at(x);
    const double curve = tube_.curve(x);
    // The place is off by off_mm / slope, which moves the slope and the sine; the slope itself is off, and so
    // is the sine over the radius next to the axis, where the tube's error falls with the distance; where the
    // intensity is not even it moves too.
    const double share = (2 * tube_.off_slope + 2 * std::abs(curve / slope) * tube_.off_mm +
                          light_.steepness(theta) * half * tube_.off_mm) /
                         std::abs(slope);
    const double off_weight =
        course.level ? 0 : course.off + std::abs(course.slope(x) / slope) * tube_.off_mm;
    worst_error_ = std::max(worst_error_, value * share + full * off_weight);
    if (!std::isfinite(value)) worst_error_ = HUGE_VAL;
    return value;
  }
  double worst_error() const { return worst_error_; }

 private:
  const Tube& tube_;
  const Stretch& stretch_;
  const AxialLight& light_;
  const AxialEnd& axis_;
  double worst_error_ = 0;
};

/// An irradiance and how far it may be off.
struct Found {
  double value, error;
};

class Polisher {
 public:
  Polisher(const TubeTracer& tracer, const AxialLight& light, int most_rays)
      : tracer_(tracer), light_(light), most_rays_(most_rays) {}

  /// The branch that lands at `rho` near `theta`.
  Found irradiance(const Tube& tube, const AxialEnd& axis, double theta, double rho) {
    if (rays_ >= most_rays_) return {0, HUGE_VAL};  // a branch left out
    double before = 0, value = 0;
    // Newton doubles the digits: from the tube's three to all of them in three steps.
    for (int step = 0; step < 5; ++step) {
      const Landing* landing = trace(tube, theta);
      if (landing == nullptr) break;
      before = value;
      value = landing->weight * branch_irradiance(light_, theta, rho, landing->slope_mm_per_rad, axis);
      if (!std::isfinite(value)) return {value, 0};
      const double move = (rho - landing->rho_mm) / landing->slope_mm_per_rad;
      const bool settled = std::abs(move) <= 1e-15 * theta;  // a few roundings of the angle
      theta = std::clamp(theta + move, tube.first_rad, tube.last_rad);
      if (settled) before = value;  // what this ray gives is final, however far the one before was
      if (settled || (step > 0 && std::abs(value - before) <= 1e-13 * value)) break;
    }
    // Past the last two steps agreeing to 1e-13 what is left is rounding in the ray's derivative.
    return {value, std::max(1e-12 * value, std::abs(value - before))};
  }

  int rays() const { return rays_; }

 private:
  const Landing* trace(const Tube& tube, double theta) {
    landings_.clear();
    tracer_.trace(theta, landings_);
    ++rays_;
    for (const Landing& landing : landings_)
      if (landing.path == tube.path) return &landing;
    return nullptr;
  }

  const TubeTracer& tracer_;
  const AxialLight& light_;
  int most_rays_, rays_ = 0;
  std::vector<Landing> landings_;
};

class PointwiseAdder {
 public:
  PointwiseAdder(const TubeTracer& tracer, const AxialLight& light, double tolerance, int most_rays,
                 std::span<const double> radii_mm, std::vector<double>& values)
      : tracer_(tracer),
        polisher_(tracer, light, most_rays),
        light_(light),
        tolerance_(share * tolerance),
        most_rays_(most_rays),
        radii_(radii_mm),
        values_(values),
        errors_(radii_mm.size(), 0.0) {}

  /// By the tube alone where that is within the tolerance; else by its halves, as long as these save rays;
  /// else with rays for each radius.
  void add(const Tube& tube, int depth = 0) {
    const AxialEnd axis = axial_end(tube);
    const std::vector<Band> bands = bands_of(tube);
    std::vector<Sum> sums;
    std::size_t left = 0;  // radii for which the tube does not suffice
    for (const Band& band : bands) {
      sums.push_back(by_tube(tube, band, axis));
      if (!sums.back().suffices) left += band.end - band.first;
    }
    // A radius takes some three rays. Where branches meet in a fold, halves never suffice: the depth ends it.
    constexpr int most_depth = 16;
    if (tolerance_ > 0 && 3 * left > 2 * rays_of_halving && depth < most_depth &&
        rays_ + rays_of_halving <= most_rays_) {
      rays_ += rays_of_halving;
      if (const auto halves = halves_of(tube, tracer_)) {
        for (const Tube& half : *halves) add(half, depth + 1);
        return;
      }
    }
    for (std::size_t k = 0; axis.exists && k < radii_.size() && radii_[k] <= std::abs(axis.rho); ++k)
      values_[k] += tube.weight * tube.course.at(axis.polar > 0 ? 1 : -1) *
                    branch_irradiance(light_, axis.polar, 0, axis.slope, axis);
    for (std::size_t i = 0; i < bands.size(); ++i) {
      if (sums[i].suffices)
        take(bands[i], sums[i]);
      else
        add_by_rays(tube, bands[i], axis);
    }
  }

  PointwiseSum sum() const {
    return {*std::max_element(errors_.begin(), errors_.end()), rays_ + polisher_.rays()};
  }

 private:
  /// The radii [first, end) at which a stretch lands on one side of the axis.
  struct Band {
    Stretch stretch;
    double side;
    std::size_t first, end;
  };

  /// What a tube gives at a band's radii.
  struct Sum {
    bool suffices = false;
    std::vector<double> values = {};
    double error = 0;
  };

  /// Half-open, so that a radius at a common end belongs to one tube; radius 0 belongs to the side +.
  static bool lands(const Stretch& stretch, double rho) {
    return (stretch.rho_first < rho) != (stretch.rho_last < rho) && !(rho == 0 && std::signbit(rho));
  }

  std::vector<Band> bands_of(const Tube& tube) const {
    std::vector<Band> bands;
    const Stretches stretches = monotone_stretches(tube);
    for (std::size_t i = 0; i < stretches.count; ++i) {
      const Stretch& stretch = stretches.part[i];
      const auto from = std::lower_bound(radii_.begin(), radii_.end(), stretch.inner()),
                 to = std::upper_bound(from, radii_.end(), stretch.outer());
      for (const double side : {1.0, -1.0}) {
        Band band{stretch, side, static_cast<std::size_t>(from - radii_.begin()),
                  static_cast<std::size_t>(to - radii_.begin())};
        while (band.first < band.end && !lands(stretch, side * radii_[band.first])) ++band.first;
        while (band.first < band.end && !lands(stretch, side * radii_[band.end - 1])) --band.end;
        if (band.first < band.end) bands.push_back(band);
      }
    }
    return bands;
  }

  Sum by_tube(const Tube& tube, const Band& band, const AxialEnd& axis) const {
    if (!(tolerance_ > 0)) return {};
    TubeIrradiance irradiance(tube, band.stretch, light_, axis);
    // Errors are greatest at one end, where branches meet or the axis is near: most tubes fail there at once.
    irradiance.at(band.side * radii_[band.first]);
    irradiance.at(band.side * radii_[band.end - 1]);
    if (!(irradiance.worst_error() <= tolerance_)) return {};
    const RadialFunction function{1, [&](std::span<const double> at, std::span<double> values) {
                                    for (std::size_t k = 0; k < at.size(); ++k)
                                      values[k] = irradiance.at(band.side * at[k]);
                                  }};
    // One tube of some may take this share of the tolerance for being interpolated.
    const double allowed[] = {0.1 * tolerance_};
    RadialValues found =
        interpolate(function, radii_.subspan(band.first, band.end - band.first), {}, HUGE_VAL, allowed);
    const double error = irradiance.worst_error() + found.error[0];
    return {error <= tolerance_, std::move(found.values), error};
  }

  void take(const Band& band, const Sum& sum) {
    for (std::size_t k = band.first; k < band.end; ++k) {
      values_[k] += sum.values[k - band.first];
      errors_[k] += sum.error;
    }
  }

  void add_by_rays(const Tube& tube, const Band& band, const AxialEnd& axis) {
    for (std::size_t k = band.first; k < band.end; ++k) {
      const double rho = band.side * radii_[k];
      if (!lands(band.stretch, rho)) continue;
      const Found found =
          polisher_.irradiance(tube, axis, tube.theta_rad(place_of(tube, band.stretch, rho)), rho);
      values_[k] += found.value;
      errors_[k] += found.error;
    }
  }

  /// Of the tolerance, for one of the branches that land at a radius.
  static constexpr double share = 0.3;

  const TubeTracer& tracer_;
  Polisher polisher_;
  const AxialLight& light_;
  double tolerance_;
  int most_rays_, rays_ = 0;  ///< of halvings
  std::span<const double> radii_;
  std::vector<double>& values_;
  std::vector<double> errors_;
};

}  // namespace

PointwiseSum add_pointwise(const TubeMap& map, const TubeTracer& tracer, const AxialLight& light,
                           double tolerance, int most_rays, std::span<const double> radii_mm,
                           std::vector<double>& values) {
  PointwiseAdder adder(tracer, light, tolerance, most_rays, radii_mm, values);
  for (const Tube& tube : map.tubes) adder.add(tube);
  return adder.sum();
}

}  // namespace catoptric::sim
