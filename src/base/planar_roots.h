#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace catoptric::planar {

inline constexpr std::size_t most_coefficients = 10;
using Coefficients = std::array<double, most_coefficients>;

/// A polynomial a(s) in Bernstein form over a piece [lo, lo + width] of a span, with the weights: a / w is a
/// length, known within `error`, whatever the weights.
struct SignedForm {
  Coefficients a, w;
  double lo, width;
  bool free_lo, free_hi;  ///< a zero at a free end is a root, elsewhere zero counts as positive
};

/// Root of a0 (1 - s) + a1 s.
inline double linear_root(double a0, double a1) { return a0 / (a0 - a1); }

/// Roots of a0 (1-s)^2 + 2 a1 s (1-s) + a2 s^2 in [0, 1]. With unlike signs at the ends there is exactly one
/// and its formula does not cancel; with like signs none, two, or a touch within the rounding of the
/// discriminant, which counts once.
/// @from  Higham, Accuracy and Stability, 2nd ed., section 1.8, in s / (1 - s)
template <typename Emit>
void quadratic_roots(const SignedForm& form, double error, const Emit& emit) {
  const double a0 = form.a[0], a1 = form.a[1], a2 = form.a[2];
  const bool end_lo = form.free_lo && a0 == 0, end_hi = form.free_hi && a2 == 0;
  if (end_lo || end_hi) {
    if (end_lo) emit(0.0);
    if (end_hi) emit(1.0);
    if (end_lo && !end_hi && ((a1 < 0) != (a2 < 0)) && a1 != 0) emit(linear_root(2 * a1, a2));
    if (end_hi && !end_lo && ((a1 < 0) != (a0 < 0)) && a1 != 0) emit(linear_root(a0, 2 * a1));
    return;
  }
  const bool negative = a2 < 0;
  if ((a0 < 0) != negative) {
    const double q = -(a1 + std::copysign(std::sqrt(a1 * a1 - a0 * a2), a1));
    if (q == 0) return emit(a0 == 0 ? 0.0 : 1.0);
    return emit((q < 0) == negative ? q / (q + a2) : a0 / (a0 + q));
  }
  if (a1 == 0 || (a1 < 0) == negative) return;
  const double product = a0 * a2;
  const double discriminant = std::fma(a1, a1, -product) - std::fma(a0, a2, -product);
  const double doubt =
      error * (2 * std::abs(a1) * form.w[1] + std::abs(a0) * form.w[2] + std::abs(a2) * form.w[0]);
  if (discriminant < -doubt) return;
  if (discriminant <= doubt) return emit(a1 / (a1 - a2));
  const double q = -(a1 + std::copysign(std::sqrt(discriminant), a1));
  emit(a0 / (a0 + q));
  emit(q / (q + a2));
}

/// All roots of a form of any degree, each once.
/// @from  Farouki & Rajan 1987; the sign rules of cad's engine "meridian", here on degree p
template <typename Emit>
class RootFinder {
 public:
  RootFinder(int degree, double error, const Emit& emit)
      : last_(static_cast<std::size_t>(degree)), error_(error), emit_(emit) {}

  void find(const SignedForm& whole) {
    // One more than the deepest halving: below 2^-48 of the span a piece is at the rounding of its parameter.
    constexpr int deepest = 48;
    std::array<SignedForm, deepest + 2> stack;
    std::array<int, deepest + 2> depths{};
    std::size_t size = 1;
    stack[0] = whole;
    while (size > 0) {
      --size;
      const int depth = depths[size];
      if (settle(stack[size], depth == deepest)) continue;
      const SignedForm piece = stack[size];
      halve(piece, stack[size + 1], stack[size]);
      depths[size] = depths[size + 1] = depth + 1;
      size += 2;
    }
  }

 private:
  int certain_sign(const SignedForm& form, std::size_t i) const {
    const double bound = error_ * form.w[i];
    return form.a[i] > bound ? 1 : form.a[i] < -bound ? -1 : 0;
  }

  /// Deals with a piece whose roots are known, or says that it must be halved.
  bool settle(const SignedForm& form, bool final) {
    std::size_t first = 0, last = last_;
    if (form.free_lo && form.a[0] == 0) ++first;  // a = s q(s): the other coefficients have the signs of q's
    if (form.free_hi && form.a[last_] == 0) --last;
    bool certain = true, rises = true, falls = true, within_rounding = true;
    int variations = 0, current = 0;
    for (std::size_t i = first; i <= last && last <= last_; ++i) {
      const int sign = certain_sign(form, i);
      certain = certain && sign != 0;
      within_rounding = within_rounding && sign == 0;
      if (sign != 0 && current != 0 && sign != current) ++variations;
      if (sign != 0) current = sign;
    }
    if (certain && variations == 0) return emit_free_ends(form, first, last);
    if (certain && variations == 1) {
      emit_free_ends(form, first, last);
      emit_inside(form);
      return true;
    }
    for (std::size_t i = 0; i < last_; ++i) {
      const double step = form.a[i + 1] - form.a[i];
      const double bound = error_ * (form.w[i] + form.w[i + 1]);
      rises = rises && step > bound;
      falls = falls && step < -bound;
    }
    if (rises || falls) {
      if (first > 0 || last < last_) return emit_free_ends(form, first, last);
      if ((form.a[0] < 0) != (form.a[last_] < 0)) emit_inside(form);
      return true;
    }
    if (!final && !within_rounding) return false;
    // A touch to within rounding; neighbouring pieces of it are one.
    if (form.lo != touch_end_) emit_(form.lo + 0.5 * form.width);
    touch_end_ = form.lo + form.width;
    return true;
  }

  bool emit_free_ends(const SignedForm& form, std::size_t first, std::size_t last) {
    if (first > 0) emit_(form.lo);
    if (last < last_) emit_(form.lo + form.width);
    return true;
  }

  void halve(const SignedForm& piece, SignedForm& left, SignedForm& right) const {
    right = piece;
    for (std::size_t level = 0; level <= last_; ++level) {
      left.a[level] = right.a[0];
      left.w[level] = right.w[0];
      for (std::size_t i = 0; i + level < last_; ++i) {
        right.a[i] = 0.5 * (right.a[i] + right.a[i + 1]);
        right.w[i] = 0.5 * (right.w[i] + right.w[i + 1]);
      }
    }
    left.lo = piece.lo;
    left.width = right.width = 0.5 * piece.width;
    right.lo = piece.lo + left.width;
    left.free_lo = piece.free_lo;
    left.free_hi = right.free_lo = false;
    right.free_hi = piece.free_hi;
  }

  /// Value and slope at t in the piece.
  std::pair<double, double> value(const SignedForm& form, double t) const {
    Coefficients a = form.a;
    for (std::size_t level = last_; level > 1; --level)
      for (std::size_t i = 0; i < level; ++i) a[i] += t * (a[i + 1] - a[i]);
    const double rise = a[1] - a[0];
    return {a[0] + t * rise, static_cast<double>(last_) * rise};
  }

  /// The one root in a piece whose ends have unlike signs: Newton, kept in the bracket by bisection.
  void emit_inside(const SignedForm& form) {
    constexpr double roundoff = std::numeric_limits<double>::epsilon();
    const double a0 = form.a[0], an = form.a[last_];
    const bool negative_lo = form.free_hi && an == 0 ? a0 < 0 : !(an < 0);
    double lo = 0, hi = 1, t = 0.5;
    if ((a0 < 0) != (an < 0) && a0 != 0 && an != 0) t = a0 / (a0 - an);
    for (int step = 0; step < 100 && hi - lo > roundoff; ++step) {
      const auto [a, slope] = value(form, t);
      if (a == 0) break;
      ((a < 0) == negative_lo ? lo : hi) = t;
      const double next = t - a / slope;
      const double before = t;
      t = next > lo && next < hi ? next : 0.5 * (lo + hi);
      if (std::abs(t - before) <= roundoff) break;
    }
    emit_(form.lo + form.width * t);
  }

  std::size_t last_;
  double error_;
  const Emit& emit_;
  double touch_end_ = -1;
};

}  // namespace catoptric::planar
