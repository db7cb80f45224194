#include "sim/radial_panels.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/units.h"
#include "base/vector_clones.h"

namespace catoptric::sim {
namespace {

constexpr std::size_t most_degree = 32;

/// cos(pi k / 32) for k from 0 to 64.
const std::array<double, 2 * most_degree + 1>& cosines() {
  static const auto table = [] {
    std::array<double, 2 * most_degree + 1> values{};
    for (std::size_t k = 0; k < values.size(); ++k)
      values[k] = std::cos(pi * static_cast<double>(k) / static_cast<double>(most_degree));
    return values;
  }();
  return table;
}

struct Series {
  std::array<double, most_degree + 1> c;
  std::size_t degree;
};

/// The Chebyshev series through values at cos(pi i / degree), which are every `stride`th of `values`.
Series series_of(const double* values, std::size_t stride, std::size_t degree) {
  const auto& cosine = cosines();
  const std::size_t step = most_degree / degree;
  Series series{{}, degree};
  for (std::size_t k = 0; k <= degree; ++k) {
    double sum = 0;
    for (std::size_t i = 0; i <= degree; ++i) {
      const double half = i == 0 || i == degree ? 0.5 : 1;
      sum += half * values[i * stride] * cosine[(i * k * step) % (2 * most_degree)];
    }
    series.c[k] = (k == 0 || k == degree ? 1.0 : 2.0) * sum / static_cast<double>(degree);
  }
  return series;
}

/// @from  Clenshaw 1955
inline double value_of(const Series& series, double x) {
  double next = 0, after = 0;
  for (std::size_t k = series.degree; k > 0; --k) {
    const double here = 2 * x * next - after + series.c[k];
    after = next;
    next = here;
  }
  return x * next - after + series.c[0];
}

/// The series at many places.
CATOPTRIC_VECTOR_CLONES
void fill(const Series& series, const double* places, std::size_t count, std::size_t stride, double* values) {
  constexpr std::size_t lanes = 16;
  for (std::size_t start = 0; start < count; start += lanes) {
    const std::size_t size = std::min(lanes, count - start);
    std::array<double, lanes> x{}, next{}, after{};
    for (std::size_t i = 0; i < size; ++i) x[i] = places[start + i];
    for (std::size_t k = series.degree; k > 0; --k)
      for (std::size_t i = 0; i < lanes; ++i) {
        const double here = 2 * x[i] * next[i] - after[i] + series.c[k];
        after[i] = next[i];
        next[i] = here;
      }
    for (std::size_t i = 0; i < size; ++i)
      values[(start + i) * stride] = x[i] * next[i] - after[i] + series.c[0];
  }
}

/// A range of radii with its own x from -1 to 1. Next to a break, where functions go like d^3 log d or
/// d^(7/2), the radius goes like the square of the distance in x, which doubles these powers.
struct Panel {
  double low, high;
  bool breaks_low, breaks_high;
  double radius(double x) const {
    const double length = high - low;
    if (breaks_low && breaks_high) return low + 0.5 * length * (1 + std::sin(0.5 * pi * x));
    if (breaks_low) return low + 0.25 * length * (1 + x) * (1 + x);
    if (breaks_high) return high - 0.25 * length * (1 - x) * (1 - x);
    return low + 0.5 * length * (1 + x);
  }
  double place(double r) const {
    const double share = std::clamp((r - low) / (high - low), 0.0, 1.0);
    if (breaks_low && breaks_high) return 2 / pi * std::asin(2 * share - 1);
    if (breaks_low) return 2 * std::sqrt(share) - 1;
    if (breaks_high) return 1 - 2 * std::sqrt(1 - share);
    return 2 * share - 1;
  }
};

class Interpolator {
 public:
  Interpolator(const RadialFunction& function, std::span<const double> radii_mm,
               std::span<const double> allowed)
      : function_(function), radii_(radii_mm), allowed_(allowed), n_(function.components) {
    result_.values.resize(radii_mm.size() * n_);
    result_.error.resize(n_);
  }

  /// The radii [first, end), all within the panel.
  void add(const Panel& panel, std::size_t first, std::size_t end) {
    constexpr std::size_t least_degree = 4;
    if (end - first <= 2 * least_degree) return compute(first, end);
    sample(panel, 1, most_degree / least_degree);
    expand(least_degree);
    for (std::size_t degree = least_degree; 2 * degree <= most_degree; degree *= 2) {
      if (end - first <= degree) break;  // the new points cost more than the radii
      const std::size_t step = most_degree / (2 * degree);
      sample(panel, 2, step);
      half_.swap(full_);
      expand(2 * degree);
      if (accept(degree, step)) return fill_in(panel, first, end);
    }
    if (end - first <= most_degree) return compute(first, end);
    const double middle = 0.5 * (panel.low + panel.high);
    const auto cut =
        static_cast<std::size_t>(std::upper_bound(radii_.begin() + static_cast<std::ptrdiff_t>(first),
                                                  radii_.begin() + static_cast<std::ptrdiff_t>(end), middle) -
                                 radii_.begin());
    add({panel.low, middle, panel.breaks_low, false}, first, cut);
    add({middle, panel.high, false, panel.breaks_high}, cut, end);
  }

  RadialValues result() { return std::move(result_); }

 private:
  void compute(std::size_t first, std::size_t end) {
    if (first == end) return;
    function_.evaluate(radii_.subspan(first, end - first),
                       std::span(result_.values).subspan(first * n_, (end - first) * n_));
  }

  /// The series of all components.
  void expand(std::size_t degree) {
    full_.clear();
    for (std::size_t c = 0; c < n_; ++c)
      full_.push_back(series_of(nodes_.data() + c, most_degree / degree * n_, degree));
  }

  void fill_in(const Panel& panel, std::size_t first, std::size_t end) {
    places_.resize(end - first);
    for (std::size_t k = first; k < end; ++k) places_[k - first] = panel.place(radii_[k]);
    for (std::size_t c = 0; c < n_; ++c)
      fill(full_[c], places_.data(), end - first, n_, result_.values.data() + first * n_ + c);
  }

  /// Values at the points 0, step, 2 step, ... of 33; with `every` = 2 only at the odd ones of them.
  void sample(const Panel& panel, std::size_t every, std::size_t step) {
    at_.clear();
    for (std::size_t i = (every - 1) * step; i <= most_degree; i += every * step)
      at_.push_back(panel.radius(cosines()[i]));
    fresh_.resize(at_.size() * n_);
    function_.evaluate(at_, fresh_);
    nodes_.resize((most_degree + 1) * n_);
    for (std::size_t k = 0; k < at_.size(); ++k)
      std::copy_n(fresh_.begin() + static_cast<std::ptrdiff_t>(k * n_), n_,
                  nodes_.begin() + static_cast<std::ptrdiff_t>(((every - 1) * step + k * every * step) * n_));
  }

  /// Whether the interpolant of twice the `degree` is near enough; its points are `step` apart.
  bool accept(std::size_t degree, std::size_t step) {
    worst_.assign(n_, 0.0);
    for (std::size_t c = 0; c < n_; ++c) {
      double told = 0, tail = 0;
      for (std::size_t i = step; i < most_degree; i += 2 * step)
        told = std::max(told, std::abs(value_of(half_[c], cosines()[i]) - nodes_[i * n_ + c]));
      for (std::size_t k = 2 * degree; 2 * k > 3 * degree; --k) tail += std::abs(full_[c].c[k]);
      worst_[c] = std::max(2 * tail, told / 64);
      if (!(worst_[c] <= allowed_[c])) return false;
    }
    for (std::size_t c = 0; c < n_; ++c) result_.error[c] = std::max(result_.error[c], worst_[c]);
    return true;
  }

  const RadialFunction& function_;
  std::span<const double> radii_, allowed_;
  std::size_t n_;
  RadialValues result_;
  std::vector<Series> half_, full_;  ///< with half of the points and with all
  std::vector<double> at_, fresh_, nodes_, worst_, places_;
};

}  // namespace

std::vector<RadiusGroup> groups_of(std::span<const double> radii_mm, double gap_mm) {
  std::vector<RadiusGroup> groups;
  for (std::size_t i = 0; i < radii_mm.size(); ++i) {
    if (i == 0 || radii_mm[i] - radii_mm[i - 1] > gap_mm) groups.push_back({i, i});
    groups.back().end = i + 1;
  }
  return groups;
}

RadialValues interpolate(const RadialFunction& function, std::span<const double> radii_mm,
                         std::span<const double> breaks_mm, double gap_mm, std::span<const double> allowed) {
  Interpolator interpolator(function, radii_mm, allowed);
  for (const RadiusGroup& group : groups_of(radii_mm, gap_mm)) {
    double low = radii_mm[group.first];
    const double last = radii_mm[group.end - 1];
    std::size_t first = group.first;
    for (auto next = std::upper_bound(breaks_mm.begin(), breaks_mm.end(), low); first < group.end; ++next) {
      const double high = next == breaks_mm.end() ? last : std::min(*next, last);
      std::size_t end = first;
      while (end < group.end && radii_mm[end] <= high) ++end;
      interpolator.add({low, high, low > radii_mm[group.first], high < last}, first, end);
      first = end;
      low = high;
      if (high == last) break;
    }
  }
  return interpolator.result();
}

}  // namespace catoptric::sim
