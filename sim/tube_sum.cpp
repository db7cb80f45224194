#include "sim/tube_sum.h"

#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>

#include "base/units.h"
#include "sim/tube_kernel.h"

namespace catoptric::sim {
namespace {

/// A stretch of a tube on which the landing radius only rises or only falls.
struct Stretch {
  double first, last;  ///< of t
  double rho_first, rho_last;
};

struct Stretches {
  std::array<Stretch, 3> part;
  std::size_t count = 0;
};

Stretches monotone_stretches(const Tube& tube) {
  std::array<double, 4> cuts{0, 0, 0, 0};
  std::size_t count = 1;
  // Zeros of the slope c + 2 b t + a t^2, by the form of the formula that does not cancel.
  const double a = 3 * tube.rho[3], b = tube.rho[2], c = tube.rho[1];
  const double discriminant = b * b - a * c;
  if (discriminant > 0) {
    const double q = -(b + std::copysign(std::sqrt(discriminant), b));
    double first = q / a, second = c / q;
    if (second < first) std::swap(first, second);
    for (const double t : {first, second})
      if (t > 0 && t < 1) cuts[count++] = t;
  }
  cuts[count] = 1;
  Stretches stretches;
  for (std::size_t i = 0; i < count; ++i)
    stretches.part[stretches.count++] = {cuts[i], cuts[i + 1], tube.at(cuts[i]),
                                         i + 1 == count ? tube.end_mm : tube.at(cuts[i + 1])};
  return stretches;
}

/// Where the tube lands at `rho` on a stretch that passes it.
double place_of(const Tube& tube, const Stretch& stretch, double rho) {
  double low = stretch.first, high = stretch.last;
  const bool rises = stretch.rho_last > stretch.rho_first;
  double t = low + (high - low) * (rho - stretch.rho_first) / (stretch.rho_last - stretch.rho_first);
  // Newton squares what is left: after a step of this size the place is at its rounding.
  const double enough = 1e-9;
  for (int step = 0; step < 60; ++step) {
    const double off = tube.at(t) - rho;
    ((off < 0) == rises ? low : high) = t;
    double next = t - off / tube.slope(t);
    if (!(next >= low && next <= high)) next = 0.5 * (low + high);
    const double moved = std::abs(next - t);
    t = next;
    if (moved <= enough) break;
  }
  return t;
}

/// Integral over t in [first, last] of sin(theta) times the ring kernel at radius r.
template <unsigned points>
double rule(const Tube& tube, double h, double r, double first, double last) {
  const double width = tube.last_rad - tube.first_rad;
  return boost::math::quadrature::gauss<double, points>::integrate(
      [&](double t) { return std::sin(tube.first_rad + t * width) * tube_kernel_per_mm2(r, tube.at(t), h); },
      first, last);
}

/// By the length in kernel radii. Where a cut ends the stretch, the kernel ends like distance^(5/2), for
/// which n points leave n^-7; elsewhere it is a smooth function of the length, for which they leave
/// length^(2n).
double integral(const Tube& tube, double h, double r, double first, double last, double reach, bool cut) {
  // The emission angle counts too: where light gathers, much of it lands within little length.
  const double turn = (last - first) * (tube.last_rad - tube.first_rad);
  const double length = std::max((cut ? 4 : 1) * reach / h, turn);
  if (length < 0.01) return rule<2>(tube, h, r, first, last);
  if (length < 0.05) return rule<3>(tube, h, r, first, last);
  if (length < 0.3) return rule<5>(tube, h, r, first, last);
  if (length < 1.2) return rule<8>(tube, h, r, first, last);
  return rule<16>(tube, h, r, first, last);
}

/// A stretch of one tube seen from one radius: cut where a ring begins or ceases to reach the kernel.
double seen_from(const Tube& tube, const Stretch& stretch, double h, double r) {
  const double low = std::min(stretch.rho_first, stretch.rho_last),
               high = std::max(stretch.rho_first, stretch.rho_last);
  const std::array<double, 4> ends{-(r + h), -std::abs(r - h), std::abs(r - h), r + h};
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    if (i == 1 && r > h) continue;  // the hole: rings too small to reach the kernel
    const double from = std::max(low, ends[i]), to = std::min(high, ends[i + 1]);
    if (!(from < to)) continue;
    const double a = from == stretch.rho_first  ? stretch.first
                     : from == stretch.rho_last ? stretch.last
                                                : place_of(tube, stretch, from);
    const double b = to == stretch.rho_first  ? stretch.first
                     : to == stretch.rho_last ? stretch.last
                                              : place_of(tube, stretch, to);
    sum +=
        integral(tube, h, r, std::min(a, b), std::max(a, b), to - from, from == ends[i] || to == ends[i + 1]);
  }
  return sum;
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
  const double width = tube.last_rad - tube.first_rad;
  for (const AxialEnd& end : {AxialEnd{true, tube.rho[0], tube.slope(0) / width, 0},
                              AxialEnd{true, tube.end_mm, tube.slope(1) / width, pi}}) {
    const double off = end.polar > 0 ? pi - tube.last_rad : tube.first_rad;
    // The outermost ray leaves this near the axis, and lands where a straight continuation says.
    if (off < 2e-14 && std::abs(end.rho) <= 4 * std::abs(end.slope) * off) return end;
  }
  return {};
}

/// Irradiance of one branch: power sin(theta) / (4 pi rho |slope|).
double branch_irradiance(double power_w, double theta, double rho, double slope, const AxialEnd& axis) {
  const double off = std::abs(theta - axis.polar);
  // Next to the axis rho is odd in the angle, so rho / off is (2 slope(0) + slope) / 3 to the fourth order:
  // 1e-12 here, where rho itself is worth 1e-13 of the part over 1e-3 of it.
  const double ratio = axis.exists && off < 1e-3
                           ? 3 * (off > 0 ? std::sin(off) / off : 1) / (2 * axis.slope + slope)
                           : std::sin(theta) / rho;
  return power_w / (4 * pi) * std::abs(ratio / slope);
}

class Polisher {
 public:
  Polisher(const TubeTracer& tracer, double power_w, int most_rays)
      : tracer_(tracer), power_w_(power_w), most_rays_(most_rays) {}

  /// The branch that lands at `rho` near `theta`.
  double irradiance(const Tube& tube, double theta, double rho, PointwiseSum& sum) {
    if (sum.rays >= most_rays_) {
      sum.error_w_per_mm2 = HUGE_VAL;  // a branch left out
      return 0;
    }
    const AxialEnd axis = axial_end(tube);
    double before = 0, value = 0;
    // Newton doubles the digits: from the tube's three to all of them in three steps.
    for (int step = 0; step < 5; ++step) {
      const Landing* landing = trace(tube, theta, sum);
      if (landing == nullptr) break;
      before = value;
      value = tube.weight * branch_irradiance(power_w_, theta, rho, landing->slope_mm_per_rad, axis);
      if (!std::isfinite(value)) return value;
      const double move = (rho - landing->rho_mm) / landing->slope_mm_per_rad;
      const bool settled = std::abs(move) <= 1e-15 * theta;  // a few roundings of the angle
      theta = std::clamp(theta + move, tube.first_rad, tube.last_rad);
      if (settled) before = value;  // what this ray gives is final, however far the one before was
      if (settled || (step > 0 && std::abs(value - before) <= 1e-13 * value)) break;
    }
    // Past the last two steps agreeing to 1e-13 what is left is rounding in the ray's derivative.
    sum.error_w_per_mm2 = std::max(sum.error_w_per_mm2, std::max(1e-12 * value, std::abs(value - before)));
    return value;
  }

 private:
  const Landing* trace(const Tube& tube, double theta, PointwiseSum& sum) {
    landings_.clear();
    tracer_.trace(theta, landings_);
    ++sum.rays;
    for (const Landing& landing : landings_)
      if (landing.path == tube.path) return &landing;
    return nullptr;
  }

  const TubeTracer& tracer_;
  double power_w_;
  int most_rays_;
  std::vector<Landing> landings_;
};

}  // namespace

void add_smoothed(const Tube& tube, double power_w, double kernel_radius_mm, std::span<const double> radii_mm,
                  std::vector<double>& values) {
  const double scale = 0.5 * power_w * tube.weight * (tube.last_rad - tube.first_rad);
  const Stretches stretches = monotone_stretches(tube);
  for (std::size_t i = 0; i < stretches.count; ++i) {
    const Stretch& stretch = stretches.part[i];
    const double a = stretch.rho_first, b = stretch.rho_last;
    const double inner = (a < 0) != (b < 0) ? 0 : std::min(std::abs(a), std::abs(b));
    const double outer = std::max(std::abs(a), std::abs(b));
    auto place = std::lower_bound(radii_mm.begin(), radii_mm.end(), inner - kernel_radius_mm);
    for (; place != radii_mm.end() && *place < outer + kernel_radius_mm; ++place)
      values[static_cast<std::size_t>(place - radii_mm.begin())] +=
          scale * seen_from(tube, stretch, kernel_radius_mm, *place);
  }
}

PointwiseSum add_pointwise(const TubeMap& map, const TubeTracer& tracer, double power_w, int most_rays,
                           std::span<const double> radii_mm, std::vector<double>& values) {
  PointwiseSum sum;
  Polisher polisher(tracer, power_w, most_rays);
  for (const Tube& tube : map.tubes) {
    const double width = tube.last_rad - tube.first_rad;
    const AxialEnd axis = axial_end(tube);
    for (std::size_t k = 0; axis.exists && k < radii_mm.size() && radii_mm[k] <= std::abs(axis.rho); ++k)
      values[k] += tube.weight * branch_irradiance(power_w, axis.polar, 0, axis.slope, axis);
    const Stretches stretches = monotone_stretches(tube);
    for (std::size_t i = 0; i < stretches.count; ++i) {
      const Stretch& stretch = stretches.part[i];
      const double a = stretch.rho_first, b = stretch.rho_last;
      const double inner = (a < 0) != (b < 0) ? 0 : std::min(std::abs(a), std::abs(b));
      auto place = std::lower_bound(radii_mm.begin(), radii_mm.end(), inner);
      for (; place != radii_mm.end() && *place <= std::max(std::abs(a), std::abs(b)); ++place)
        for (const double rho : {*place, -*place}) {
          // Half-open, so that a radius at a common end belongs to one tube.
          if ((a < rho) == (b < rho) || (rho == 0 && std::signbit(rho))) continue;
          const double theta = tube.first_rad + width * place_of(tube, stretch, rho);
          values[static_cast<std::size_t>(place - radii_mm.begin())] +=
              polisher.irradiance(tube, theta, rho, sum);
        }
    }
  }
  return sum;
}

}  // namespace catoptric::sim
