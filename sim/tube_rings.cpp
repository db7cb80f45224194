#include "sim/tube_rings.h"

#include <algorithm>
#include <cmath>

#include "base/float_traps.h"
#include "base/units.h"
#include "base/vector_clones.h"
#include "sim/radial_panels.h"
#include "sim/sign_changes.h"
#include "sim/tube_kernel.h"

namespace catoptric::sim {
namespace {

using Block = TubeRings::Block;
using Panel = TubeRings::Panel;
using Reach = TubeRings::Reach;
constexpr std::size_t lanes = TubeRings::lanes;

/// Gauss-Legendre on [-1, 1].
constexpr std::array<double, lanes> gauss_x = {-0.9602898564975363, -0.7966664774136268, -0.525532409916329,
                                               -0.1834346424956498, 0.1834346424956498,  0.525532409916329,
                                               0.7966664774136268,  0.9602898564975363};
constexpr std::array<double, lanes> gauss_w = {0.10122853629037618, 0.22238103445337445, 0.3137066458778874,
                                               0.362683783378362,   0.362683783378362,   0.3137066458778874,
                                               0.22238103445337445, 0.10122853629037618};

/// One end of the kernel in one panel may use up this share of the tolerance.
constexpr double edge_share = 0.005;

/// Longest panel in kernel radii and in emission angle, for what is smooth: eight nodes leave some 1e-10.
constexpr double longest_panel = 0.5, longest_panel_rad = 0.2;

/// The rule's worst error on distance^(5/2) over a panel of unit length that begins there or later, times the
/// four that the kernel has before that power.
constexpr double edge_error = 4 * 5.4e-8;

/// Sine of an angle near one whose sine and cosine are known.
/// @in    |d| <= 0.2
/// @error 1e-15
__attribute__((always_inline)) inline double sine_near(double sine, double cosine, double d) {
  const double s = d * d;
  const double sine_d = d * (1 - s / 6 * (1 - s / 20 * (1 - s / 42 * (1 - s / 72))));
  const double cosine_d = 1 - s / 2 * (1 - s / 12 * (1 - s / 30 * (1 - s / 56 * (1 - s / 90))));
  return sine * cosine_d + cosine * sine_d;
}

/// Cosine likewise.
__attribute__((always_inline)) inline double cosine_near(double sine, double cosine, double d) {
  return sine_near(cosine, -sine, d);
}

/// Nodes of the part [low, high] of a panel.
__attribute__((always_inline)) inline void place_nodes(const Panel& panel, double low, double high,
                                                       Block& nodes) {
  const double centre = 0.5 * (low + high), half = 0.5 * (high - low);
  for (std::size_t i = 0; i < lanes; ++i) {
    const double x = centre + half * gauss_x[i];
    nodes.power[i] =
        half * panel.power * gauss_w[i] * sine_near(panel.sine, panel.cosine, x * panel.half_rad);
    nodes.ring[i] = panel.at(x);
  }
  if (!panel.light.law.is_even())
    for (std::size_t i = 0; i < lanes; ++i)
      nodes.power[i] *= panel.light.relative(
          cosine_near(panel.sine, panel.cosine, (centre + half * gauss_x[i]) * panel.half_rad));
  if (!panel.course.level)
    for (std::size_t i = 0; i < lanes; ++i) nodes.power[i] *= panel.course.at(centre + half * gauss_x[i]);
}

/// A block as seen from one radius, in kernel radii, added lane by lane.
__attribute__((always_inline)) inline void add_block(const Block& block, double at, double* sums) {
  for (std::size_t i = 0; i < lanes; ++i)
    sums[i] += block.power[i] * kernel_ring_mean(at, block.ring[i]).value;
}

/// Where a panel passes `ring`, which lies between its ends.
__attribute__((always_inline)) inline double place_of(const Panel& panel, double ring) {
  double low = -1, high = 1;
  const double first = panel.at(-1), last = panel.at(1);
  const bool rises = last > first;
  double x = 2 * (ring - first) / (last - first) - 1;
  // Newton squares what is left. A place off by d makes an error of d^(7/2).
  constexpr double enough = 1e-6;
  for (int step = 0; step < 60; ++step) {
    const double off = panel.at(x) - ring;
    ((off < 0) == rises ? low : high) = x;
    double next = x - off / panel.slope(x);
    if (!(next >= low && next <= high)) next = 0.5 * (low + high);
    const double moved = std::abs(next - x);
    x = next;
    if (moved <= enough) break;
  }
  return x;
}

/// The parts of a panel between the places where the kernel begins or ends, as far as it reaches them.
template <typename Take>
__attribute__((always_inline)) inline void for_each_part(const Panel& panel, const Reach& reach, double at,
                                                         double inner, double outer, const Take& take) {
  double cuts[4] = {-1, 1, 1, 1};
  std::size_t count = 1;
  for (const double edge : {inner, outer})
    if (reach.least < edge && edge < reach.most) cuts[count++] = place_of(panel, edge);
  if (count == 3 && cuts[2] < cuts[1]) std::swap(cuts[1], cuts[2]);
  cuts[count] = 1;
  for (std::size_t i = 0; i < count; ++i) {
    const double middle = panel.at(0.5 * (cuts[i] + cuts[i + 1]));
    if (middle > outer || (at > 1 && middle < inner)) continue;
    take(cuts[i], cuts[i + 1]);
  }
}

CATOPTRIC_VECTOR_CLONES
double sum_at(const Panel* panels, const Reach* reaches, std::size_t count, double at) {
  double sums[lanes] = {};
  // Rings beyond these are not reached; below at = 1 the smallest lie in the kernel as a whole.
  const double inner = std::abs(at - 1), outer = at + 1, least = at - 1;
  for (std::size_t k = 0; k < count; ++k) {
    const Reach reach = reaches[k];
    if (!(reach.most > least && reach.least < outer)) continue;
    if ((reach.least < inner && inner < reach.most) || outer < reach.most)
      for_each_part(panels[k], reach, at, inner, outer, [&](double low, double high) {
        Block nodes;
        place_nodes(panels[k], low, high, nodes);
        add_block(nodes, at, sums);
      });
    else
      add_block(panels[k].nodes, at, sums);
  }
  return ((sums[0] + sums[1]) + (sums[2] + sums[3])) + ((sums[4] + sums[5]) + (sums[6] + sums[7]));
}

/// Adds the moments of a part of a panel.
CATOPTRIC_VECTOR_CLONES
void add_moments(const Panel& panel, double low, double high, double at, std::array<double, 6>& moments) {
  Block nodes;
  place_nodes(panel, low, high, nodes);
  double answer[lanes], x[lanes];
  for (std::size_t i = 0; i < lanes; ++i) {
    answer[i] = panel.sign * nodes.power[i] * kernel_ring_mean(at, nodes.ring[i]).slope;
    x[i] = panel.centre + panel.half * (0.5 * (low + high) + 0.5 * (high - low) * gauss_x[i]);
  }
  for (double& moment : moments) {
    double sum = 0;
    for (std::size_t i = 0; i < lanes; ++i) {
      sum += answer[i];
      answer[i] *= x[i];
    }
    moment += sum;
  }
}

/// The part [low, high] of a panel as a panel.
Panel part_of(const Panel& whole, double low, double high) {
  Panel part = whole;
  const double centre = 0.5 * (low + high), half = 0.5 * (high - low);
  // Taylor shift by Horner's scheme, then the scale.
  for (std::size_t first = 0; first < 5; ++first)
    for (std::size_t k = 5; k-- > first;) part.ring[k] += centre * part.ring[k + 1];
  double scale = 1;
  for (double& c : part.ring) {
    c *= scale;
    scale *= half;
  }
  part.half_rad = whole.half_rad * half;
  part.centre = centre;  // of the tube's x, since wholes are parts of tubes
  part.half = half;
  part.power = whole.power * half;
  part.course = whole.course.part(centre, half);
  return part;
}

/// Where a tube turns or passes the axis, with its ends.
std::vector<double> cuts_of(const Tube& tube) {
  std::vector<double> cuts{-1, 1};
  std::array<double, 6> rho;
  std::array<double, 5> slope;
  double swing = 0, turn = 0;
  for (std::size_t k = 0; k < 6; ++k) {
    rho[k] = tube.rho[k];
    if (k > 0) slope[k - 1] = static_cast<double>(k) * rho[k];
    if (k > 0) swing += std::abs(rho[k]);
    if (k > 1) turn += static_cast<double>(k) * std::abs(rho[k]);
  }
  std::array<double, 5> zeros;
  std::array<double, 4> turns;
  if (!(std::abs(rho[0]) > swing))
    cuts.insert(cuts.end(), zeros.begin(), zeros.begin() + sign_changes<5>(rho, zeros));
  if (!(std::abs(slope[0]) > turn))
    cuts.insert(cuts.end(), turns.begin(), turns.begin() + sign_changes<4>(slope, turns));
  std::sort(cuts.begin(), cuts.end());
  return cuts;
}

/// Where the slope of a tube vanishes that has different signs at its ends.
double fold_of(const Tube& tube) {
  double low = -1, high = 1;
  const double sign = tube.slope(low);
  // The radius is stationary there: half of the digits of x give all of the radius.
  while (high - low > 1e-8) {
    const double middle = 0.5 * (low + high);
    (tube.slope(middle) * sign > 0 ? low : high) = middle;
  }
  return tube.at(low);
}

/// Whether a tube goes on where another ends, with the same density of light.
bool goes_on(const Tube& before, const Tube& after) {
  // A knot leaves a gap of some roundings between its sides, and may change the density.
  constexpr double gap_rad = 1e-12, kink = 1e-6;
  const double left = before.slope(1) / before.half_width_rad(),
               right = after.slope(-1) / after.half_width_rad();
  return before.path == after.path && std::abs(after.first_rad - before.last_rad) < gap_rad &&
         std::abs(left - right) <= kink * (std::abs(left) + std::abs(right));
}

/// Radii at which branches end or fold.
std::vector<double> ends_of(std::span<const Tube> tubes) {
  std::vector<double> ends;
  std::vector<bool> continued(tubes.size());
  for (std::size_t i = 0; i < tubes.size(); ++i) {
    bool begins = true;
    for (std::size_t j = i; begins && j-- > 0 && tubes[j].last_rad > tubes[i].first_rad - 1e-9;)
      if (goes_on(tubes[j], tubes[i])) {
        begins = false;
        continued[j] = true;
      }
    if (begins) ends.push_back(tubes[i].begin_mm);
    if (tubes[i].slope(-1) * tubes[i].slope(1) < 0) ends.push_back(fold_of(tubes[i]));
  }
  for (std::size_t i = 0; i < tubes.size(); ++i)
    if (!continued[i]) ends.push_back(tubes[i].end_mm);
  return ends;
}

}  // namespace

TubeRings::TubeRings(std::span<const Tube> tubes, const AxialLight& light, double kernel_radius_mm,
                     std::span<const double> radii_mm, double tolerance_w_per_mm2)
    : light_(light),
      h_(kernel_radius_mm),
      allowed_(edge_share * tolerance_w_per_mm2),
      bins_(std::max(radii_mm.back(), kernel_radius_mm)) {
  for (const RadiusGroup& group : groups_of(radii_mm, 2 * h_))
    windows_.push_back({radii_mm[group.first] / h_ - 1, radii_mm[group.end - 1] / h_ + 1});
  for (std::size_t i = 0; i < tubes.size(); ++i) add(tubes[i], i);
  for (const double end : ends_of(tubes)) {
    if (std::abs(end) < 1e-9 * h_) continue;  // the axis, across which the light goes on
    for (const double edge : {std::abs(end) - h_, std::abs(end) + h_, h_ - std::abs(end)})
      if (edge > radii_mm.front() && edge < radii_mm.back()) breaks_mm_.push_back(edge);
  }
  std::sort(breaks_mm_.begin(), breaks_mm_.end());
}

bool TubeRings::is_seen(const Reach& reach) const {
  const auto window = std::lower_bound(windows_.begin(), windows_.end(), reach.least,
                                       [](const Reach& w, double ring) { return w.most < ring; });
  return window != windows_.end() && window->least < reach.most;
}

void TubeRings::add(const Tube& tube, std::size_t index) {
  double swing = 0;
  for (std::size_t k = 1; k < 6; ++k) swing += std::abs(tube.rho[k]);
  const double centre = std::abs(tube.rho[0]);
  if (!is_seen({std::max(0.0, centre - swing) / h_, (centre + swing) / h_})) return;
  Panel whole{};
  whole.tube = index;
  whole.half_rad = tube.half_width_rad();
  whole.light = light_;
  whole.course = tube.course;
  whole.power = 0.5 * light_.power_w * tube.weight * whole.half_rad * kernel_peak_per_mm2(h_);
  const std::vector<double> cuts = cuts_of(tube);
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    if (!(cuts[i] < cuts[i + 1])) continue;
    const double sign = tube.at(0.5 * (cuts[i] + cuts[i + 1])) < 0 ? -1 : 1;
    for (std::size_t k = 0; k < 6; ++k) whole.ring[k] = sign * tube.rho[k] / h_;
    whole.sign = sign;
    divide(whole, tube.theta_rad(0), cuts[i], cuts[i + 1], 0);
  }
}

/// Halves a part of a tube until it is short enough; what no radius sees is dropped on the way.
void TubeRings::divide(const Panel& whole, double middle_rad, double low, double high, int depth) {
  const double first = whole.at(low), last = whole.at(high);
  const Reach reach{std::max(0.0, std::min(first, last)), std::max(first, last)};
  if (!is_seen(reach)) return;
  const double middle = 0.5 * (low + high);
  constexpr int deepest = 48;  // such a part is at the rounding of x
  Panel panel = part_of(whole, low, high);
  const double centre_rad = middle_rad + middle * whole.half_rad;
  panel.sine = std::sin(centre_rad);
  const double error = edge_error_of(panel, reach);
  if (depth < deepest && (is_rough(panel, centre_rad) || reach.most - reach.least > longest_panel ||
                          2 * panel.half_rad > longest_panel_rad || error > allowed_)) {
    divide(whole, middle_rad, low, middle, depth + 1);
    return divide(whole, middle_rad, middle, high, depth + 1);
  }
  panel.cosine = std::cos(centre_rad);
  place_nodes(panel, -1, 1, panel.nodes);
  panels_.push_back(panel);
  reaches_.push_back(reach);
  book(reach, error);
}

/// Whether the nodes do not follow the intensity over a panel that has light to speak of. A whole exponent n
/// makes waves of at most n a radian; another has no derivatives where the light ends, and is taken in parts
/// between which the cosine, or its power, falls by less than these factors: eight nodes leave some 1e-10.
bool TubeRings::is_rough(const Panel& panel, double centre_rad) const {
  if (light_.law.is_even()) return false;
  const double n = light_.law.exponent;
  const double a = light_.up * std::cos(centre_rad - panel.half_rad),
               b = light_.up * std::cos(centre_rad + panel.half_rad);
  const double near = std::max(a, b), far = std::max(0.0, std::min(a, b));
  constexpr double most_turn = 2, most_fall = 0.9, most_power_fall = 4;
  if (n == std::floor(n) && n * panel.half_rad <= most_turn) return false;
  const double fall = std::log(near / far);
  if (fall <= most_fall && n * fall <= most_power_fall) return false;
  constexpr double no_light = 1e-3;  // of what one end of the kernel may be wrong by
  return 2 * panel.power * light_.relative(light_.up * near) > no_light * allowed_;
}

/// What a panel leaves where the kernel ends in it or next to it.
double TubeRings::edge_error_of(const Panel& panel, const Reach& reach) const {
  const double length = reach.most - reach.least;
  const double most = light_.law.is_even() ? 1 : 2 * (light_.law.exponent + 1);
  const double power = 2 * panel.power * std::min(1.0, panel.sine + panel.half_rad) * most;
  return edge_error * power * ring_share(reach.least, 1) * length * length * std::sqrt(length);
}

/// The radii that see the panel at an end of their kernel.
void TubeRings::book(const Reach& reach, double error) {
  bins_.add((reach.least - 1) * h_, (reach.most - 1) * h_, error);
  bins_.add((reach.least + 1) * h_, (reach.most + 1) * h_, error);
  bins_.add((1 - reach.most) * h_, (1 - reach.least) * h_, error);
}

void TubeRings::smoothed(std::span<const double> at_mm, std::span<double> values) const {
  const UntrappedFloats untrapped;  // lanes compute both sides of a choice
  for (std::size_t i = 0; i < at_mm.size(); ++i)
    values[i] = sum_at(panels_.data(), reaches_.data(), panels_.size(), at_mm[i] / h_);
}

void TubeRings::moments(double at_mm, std::span<std::array<double, 6>> moments) const {
  const UntrappedFloats untrapped;  // lanes compute both sides of a choice
  std::fill(moments.begin(), moments.end(), std::array<double, 6>{});
  const double at = at_mm / h_, inner = std::abs(at - 1), outer = at + 1;
  for (std::size_t k = 0; k < panels_.size(); ++k) {
    const Reach reach = reaches_[k];
    if (!(reach.most > at - 1 && reach.least < outer)) continue;
    for_each_part(panels_[k], reach, at, inner, outer, [&](double low, double high) {
      add_moments(panels_[k], low, high, at, moments[panels_[k].tube]);
    });
  }
  for (auto& moment : moments)
    for (double& each : moment) each /= h_;
}

}  // namespace catoptric::sim
