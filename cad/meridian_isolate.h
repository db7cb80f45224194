#pragma once

#include <array>
#include <vector>

#include "cad/meridian_line.h"
#include "cad/meridian_spans.h"

namespace catoptric::cad::meridian {

inline constexpr std::size_t most_coefficients = 2 * most_degree + 1;

/// Bernstein coefficients of a numerator polynomial, each divided by that of its positive denominator. Signs
/// are the same, and every coefficient is a mean of values of the curve's size, whatever the weights.
template <typename Real>
struct Coefficients {
  std::array<Real, most_coefficients> ratio, denominator;
  int degree;
  Real error;  ///< bound of the rounding of each ratio
};

inline constexpr auto product_binomials = [] {
  // choose(p, i) choose(p, j) / choose(2p, i + j)
  std::array<std::array<std::array<double, most_poles>, most_poles>, most_poles> table{};
  const auto choose = [](int n, int k) {
    double value = 1;
    for (int i = 1; i <= k; ++i) value = value * (n - i + 1) / i;
    return value;
  };
  for (int p = 1; p <= most_degree; ++p)
    for (int i = 0; i <= p; ++i)
      for (int j = 0; j <= p; ++j)
        table[static_cast<std::size_t>(p)][static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] =
            choose(p, i) * choose(p, j) / choose(2 * p, i + j);
  return table;
}();

/// F / W^2 with F = (dz Rw)^2 - V^2 - (dz across)^2 W^2, V = h Zw + level W: negative where the generatrix is
/// inside the hyperboloid that the line sweeps about the axis, zero where the line meets the surface.
///
/// Formed anew on every piece, so that the rounding shrinks with the terms: it is that of R and Z themselves
/// (delta), not of their squares. A near-horizontal line, whose two crossings differ by |dz| R in height, and
/// one that nearly meets the vertex are then decided like any other.
/// @error `error` bounds 2 (X + V + Y) delta + 3 delta^2; delta counts the roundings of `depth` halvings
/// (each
///        degree additions of numbers no larger than the extent times the weight), of V and of the products
template <typename Real>
struct CrossingForm {
  const AxisLine<Real>& line;

  void operator()(const Homogeneous<Real>& curve, int degree, int depth, Coefficients<Real>& out) const {
    const std::size_t count = static_cast<std::size_t>(degree) + 1;
    std::array<Real, most_poles> x, v;
    Real largest = line.skew;
    for (std::size_t i = 0; i < count; ++i) {
      x[i] = line.dz * (curve.rw[i] / curve.w[i]);
      v[i] = line.h * (curve.zw[i] / curve.w[i]) + line.level;
      largest = greater_of(largest, greater_of(absolute(x[i]), absolute(v[i])));
    }
    out.degree = 2 * degree;
    out.ratio.fill(0);
    out.denominator.fill(0);
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t j = 0; j < count; ++j) {
        const Real share = Real(product_binomials[count - 1][i][j]) * (curve.w[i] * curve.w[j]);
        out.ratio[i + j] += share * (x[i] * x[j] - v[i] * v[j]);
        out.denominator[i + j] += share;
      }
    const Real skew_squared = line.skew * line.skew;
    for (std::size_t k = 0; k < 2 * count - 1; ++k)
      out.ratio[k] = out.ratio[k] / out.denominator[k] - skew_squared;
    // The ends without the detour over the weights: equal in neighbours, bit for bit.
    for (const std::size_t end : {std::size_t{0}, count - 1})
      out.ratio[2 * end] = x[end] * x[end] - v[end] * v[end] - skew_squared;
    const Real delta =
        Real(16 + 10 * degree + 2 * degree * depth) * Precision<Real>::unit_roundoff * line.scale;
    out.error = Real(12) * largest * delta + Real(4) * delta * delta;
  }
};

/// (Zw - oz W) / W: the crossings of the plane in which a horizontal line lies.
template <typename Real>
struct LevelForm {
  const AxisLine<Real>& line;
  double z_extent;

  void operator()(const Homogeneous<Real>& curve, int degree, int depth, Coefficients<Real>& out) const {
    out.degree = degree;
    for (std::size_t i = 0; i <= static_cast<std::size_t>(degree); ++i) {
      out.ratio[i] = curve.zw[i] / curve.w[i] - line.oz;
      out.denominator[i] = curve.w[i];
    }
    out.error = Real(16 + 6 * degree + 2 * degree * depth) * Precision<Real>::unit_roundoff *
                (Real(z_extent) + absolute(line.oz));
  }
};

/// Where one root is: a piece of a span. The signs are those of the values at its ends; equal signs mean
/// a touch that no arithmetic at hand tells from two roots or none.
template <typename Real>
struct Bracket {
  Real lo, hi;
  int span;
  int sign_lo, sign_hi;  ///< 0: exactly zero at a free end of the generatrix
  bool cluster;          ///< all values in it are within rounding of zero
};

/// Finds all roots of a form on a piece, each in a bracket of its own, by the sign rules for Bernstein
/// coefficients and halving.
///
/// What makes it certain: a coefficient counts as positive or negative only beyond its error bound; the signs
/// of values at piece ends are computed once from the same numbers for both neighbours (zero counts as +), so
/// a root at a knot or a dyadic point falls to exactly one side.
/// @from  Farouki & Rajan 1987 (Bernstein stability); variation diminishing: Lane & Riesenfeld 1981
template <typename Real, typename Form>
class Isolator {
 public:
  Isolator(const Form& form, int degree, std::vector<Bracket<Real>>& out)
      : form_(form), degree_(degree), out_(out) {}

  /// @out   false when double cannot decide (never in Quad, where what is left is a cluster)
  /// @cost  a few halvings; about as many as digits asked for next to a tangency
  bool run(const Piece<Real>& whole) {
    std::array<Piece<Real>, Precision<Real>::deepest + 2> stack;
    std::array<int, Precision<Real>::deepest + 2> depths;
    std::size_t size = 1;
    stack[0] = whole;
    depths[0] = 0;
    while (size > 0) {
      --size;
      const Piece<Real> piece = stack[size];
      const int depth = depths[size];
      form_(piece.curve, degree_, depth, coefficients_);
      switch (judge(piece, depth)) {
        case Verdict::settled:
          break;
        case Verdict::undecided:
          return false;
        case Verdict::split:
          halve(piece, degree_, stack[size + 1], stack[size]);
          depths[size] = depths[size + 1] = depth + 1;
          size += 2;
          break;
      }
    }
    return true;
  }

 private:
  enum class Verdict { settled, undecided, split };
  static constexpr bool last_resort = !std::is_same_v<Real, double>;

  int sign(Real value, bool free_end) const {
    if (value == 0 && free_end) return 0;
    return value < 0 ? -1 : 1;
  }
  int certain_sign(Real value, Real error) const { return value > error ? 1 : (value < -error ? -1 : 0); }

  void emit(const Piece<Real>& piece, int sign_lo, int sign_hi, bool cluster) {
    const Real hi = piece.lo + piece.width;
    if (cluster && !out_.empty()) {
      Bracket<Real>& before = out_.back();
      if (before.cluster && before.span == piece.span && before.hi == piece.lo) {
        before.hi = hi;
        before.sign_hi = sign_hi;
        return;
      }
    }
    out_.push_back({piece.lo, hi, piece.span, sign_lo, sign_hi, cluster});
  }

  Verdict judge(const Piece<Real>& piece, int depth);
  /// Number of roots if the signs of the coefficients tell it, else -1.
  int count_by_signs() const;
  /// The same by the signs of the differences: +1 or -1 when F certainly rises or falls over the piece.
  int slope() const;

  const Form& form_;
  int degree_;
  std::vector<Bracket<Real>>& out_;
  Coefficients<Real> coefficients_;
};

template <typename Real, typename Form>
int Isolator<Real, Form>::count_by_signs() const {
  const auto& c = coefficients_;
  const std::size_t last = static_cast<std::size_t>(c.degree);
  int current = certain_sign(c.ratio[0], c.error);
  if (current == 0 || certain_sign(c.ratio[last], c.error) == 0) return -1;
  int variations = 0;
  bool doubt = false;  // an uncertain coefficient between equal signs may hide two variations
  for (std::size_t i = 1; i <= last; ++i) {
    const int next = certain_sign(c.ratio[i], c.error);
    if (next == 0) {
      doubt = true;
    } else {
      if (next != current)
        ++variations;
      else if (doubt)
        return -1;
      doubt = false;
      current = next;
    }
  }
  return variations <= 1 ? variations : -1;
}

template <typename Real, typename Form>
int Isolator<Real, Form>::slope() const {
  const auto& c = coefficients_;
  int direction = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(c.degree); ++i) {
    const Real rise = c.ratio[i + 1] * c.denominator[i + 1] - c.ratio[i] * c.denominator[i];
    const int next = certain_sign(rise, c.error * (c.denominator[i] + c.denominator[i + 1]));
    if (next == 0 || next == -direction) return 0;
    direction = next;
  }
  return direction;
}

template <typename Real, typename Form>
typename Isolator<Real, Form>::Verdict Isolator<Real, Form>::judge(const Piece<Real>& piece, int depth) {
  const auto& c = coefficients_;
  const Real front = c.ratio[0], back = c.ratio[static_cast<std::size_t>(c.degree)];
  const int count = count_by_signs();
  if (count == 0) return Verdict::settled;
  const int sign_lo = sign(front, piece.free_lo), sign_hi = sign(back, piece.free_hi);
  if (count == 1) {
    emit(piece, sign_lo, sign_hi, false);
    return Verdict::settled;
  }
  if (sign_lo == 0 || sign_hi == 0) {  // the line meets an end of the generatrix: in double only perhaps
    if (!last_resort) return Verdict::undecided;
  }
  if (slope() != 0) {
    if (sign_lo != sign_hi) emit(piece, sign_lo, sign_hi, false);
    return Verdict::settled;
  }
  bool within_rounding = true;
  for (std::size_t i = 0; i <= static_cast<std::size_t>(c.degree); ++i)
    within_rounding = within_rounding && certain_sign(c.ratio[i], c.error) == 0;
  if (!within_rounding && depth < Precision<Real>::deepest) return Verdict::split;
  if (!last_resort) return Verdict::undecided;
  if (depth > 0) emit(piece, sign_lo, sign_hi, true);  // a whole span of zeros: the line lies in the surface
  return Verdict::settled;
}

}  // namespace catoptric::cad::meridian
