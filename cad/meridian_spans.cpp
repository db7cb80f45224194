#include "cad/meridian_spans.h"

#include <algorithm>
#include <cmath>

#include "base/bernstein.h"

namespace catoptric::cad::meridian {
namespace {

using Index = std::size_t;
using QuadVector = std::vector<Quad>;

QuadVector product(const QuadVector& a, const QuadVector& b) {
  const int m = static_cast<int>(a.size()) - 1, n = static_cast<int>(b.size()) - 1;
  QuadVector result(static_cast<Index>(m + n + 1), Quad(0));
  for (int i = 0; i <= m; ++i)
    for (int j = 0; j <= n; ++j)
      result[static_cast<Index>(i + j)] += Quad(binomial(m, i)) * Quad(binomial(n, j)) /
                                           Quad(binomial(m + n, i + j)) * a[static_cast<Index>(i)] *
                                           b[static_cast<Index>(j)];
  return result;
}

QuadVector differences(const QuadVector& a) {
  QuadVector result;
  for (Index i = 0; i + 1 < a.size(); ++i) result.push_back(a[i + 1] - a[i]);
  return result;
}

QuadVector magnitudes(QuadVector a) {
  for (Quad& value : a) value = absolute(value);
  return a;
}

QuadVector absolute_differences(const QuadVector& a) {
  QuadVector result;
  for (Index i = 0; i + 1 < a.size(); ++i) result.push_back(absolute(a[i + 1]) + absolute(a[i]));
  return result;
}

/// Numerator x' w^2 = (xw)' w - xw w' of the derivative of x. What is no more than the rounding of the span's
/// own doubles is exactly zero: z0 = z1 means a level tangent, whatever w0 z0 and w1 z1 were rounded to.
QuadVector derivative_numerator(const QuadVector& xw, const QuadVector& w) {
  const QuadVector plus = product(differences(xw), w), minus = product(xw, differences(w));
  const QuadVector scale_plus = product(absolute_differences(xw), w);
  const QuadVector scale_minus = product(magnitudes(xw), absolute_differences(w));
  QuadVector result(plus.size());
  constexpr double roundings = 8;
  for (Index i = 0; i < plus.size(); ++i) {
    const Quad noise = Quad(roundings * Precision<double>::unit_roundoff) * (scale_plus[i] + scale_minus[i]);
    result[i] = plus[i] - minus[i];
    if (absolute(result[i]) <= noise) result[i] = 0;
  }
  return result;
}

/// Divides two polynomials by s as often as both have that factor.
void divide_by_parameter(QuadVector& a, QuadVector& b) {
  while (a.size() > 1 && a.front() == 0 && b.front() == 0) {
    const Index m = a.size() - 1;
    for (Index i = 1; i <= m; ++i) {
      const Quad factor = Quad(static_cast<double>(m)) / Quad(static_cast<double>(i));
      a[i - 1] = factor * a[i];
      b[i - 1] = factor * b[i];
    }
    a.pop_back();
    b.pop_back();
  }
}

void set_tangent(SpanForm& form, const QuadVector& rw, const QuadVector& zw, const QuadVector& w) {
  QuadVector r = derivative_numerator(rw, w), z = derivative_numerator(zw, w);
  for (int end = 0; end < 2; ++end) {  // by s, then, turned round, by 1 - s
    divide_by_parameter(r, z);
    std::reverse(r.begin(), r.end());
    std::reverse(z.begin(), z.end());
  }
  Quad scale = 0;
  for (Index i = 0; i < r.size(); ++i) scale = greater_of(scale, greater_of(absolute(r[i]), absolute(z[i])));
  form.is_point = scale == 0;
  if (form.is_point) scale = 1;
  form.tangent_degree = static_cast<int>(r.size()) - 1;
  for (Index i = 0; i < r.size(); ++i) {
    const Quad factor = Quad(binomial(form.tangent_degree, static_cast<int>(i))) / scale;
    form.tangent_r[i] = static_cast<double>(factor * r[i]);
    form.tangent_z[i] = static_cast<double>(factor * z[i]);
  }
}

/// Whether the generatrix ends where it begins.
bool is_closed(const RationalSpan& front, const RationalSpan& back) {
  const Quad w0 = front.w.front(), w1 = back.w.back();
  return front.rw.front() * w1 == back.rw.back() * w0 && front.zw.front() * w1 == back.zw.back() * w0;
}

/// Adds the ends of a span that lie on the axis, a shared one once.
/// @out   whether no other point of the span can be there: no pole beyond the axis, one off it
bool find_axis_points(const Piece<Quad>& span, int degree, std::vector<AxisPoint>& out) {
  const auto& c = span.curve;
  const Index last = static_cast<Index>(degree);
  const bool after_shared = !out.empty() && out.back().span == span.span - 1 && out.back().s == 1;
  if (c.rw[0] == 0 && !after_shared) out.push_back({span.span, 0, static_cast<double>(c.zw[0] / c.w[0])});
  if (c.rw[last] == 0) out.push_back({span.span, 1, static_cast<double>(c.zw[last] / c.w[last])});
  const auto begin = c.rw.begin(), end = begin + degree + 1;
  return std::all_of(begin, end, [](Quad rw) { return rw >= 0; }) &&
         std::any_of(begin, end, [](Quad rw) { return rw > 0; });
}

}  // namespace

SpanTable::SpanTable(const Profile& profile)
    : degree(profile.degree()),
      centre_z(0.5 * (profile.z_min_mm() + profile.z_max_mm())),
      r_extent(0),
      z_extent(0),
      axis_points_known(true) {
  const double half_height = 0.5 * (profile.z_max_mm() - profile.z_min_mm());
  constexpr double slack = 1 + 1e-6;  // a cull may let a ray pass, never lose one
  reach_squared = slack * (profile.r_max_mm() * profile.r_max_mm() + half_height * half_height);
  const bool closed = is_closed(profile.spans().front(), profile.spans().back());
  const Index count = static_cast<Index>(degree) + 1;

  for (const RationalSpan& span : profile.spans()) {
    const int number = static_cast<int>(spans.size());
    SpanForm form{};
    form.first = span.first;
    form.last = span.last;
    form.width = span.last - span.first;
    Piece<Quad> piece{{}, 0, 1, number, false, false};
    QuadVector rw(count), zw(count), w(count);
    for (Index i = 0; i < count; ++i) {
      rw[i] = span.rw[i];
      zw[i] = span.zw[i];
      w[i] = span.w[i];
      piece.curve.rw[i] = rw[i];
      piece.curve.zw[i] = zw[i] - Quad(centre_z) * w[i];  // exact
      piece.curve.w[i] = w[i];
      const double choose = binomial(degree, static_cast<int>(i));
      form.rw[i] = choose * span.rw[i];
      form.zw[i] = choose * static_cast<double>(piece.curve.zw[i]);
      form.w[i] = choose * span.w[i];
      r_extent = std::max(r_extent, std::abs(span.rw[i] / span.w[i]));
      z_extent = std::max(z_extent, std::abs(static_cast<double>(piece.curve.zw[i] / w[i])));
    }
    set_tangent(form, rw, zw, w);
    piece.free_lo = !closed && spans.empty();
    piece.free_hi = !closed && spans.size() + 1 == profile.spans().size();
    axis_points_known = find_axis_points(piece, degree, axis_points) && axis_points_known;
    spans.push_back(form);
    exact.push_back(piece);
    Piece<Quad> left{}, right{};  // all their places are rounded later, also those above the degree
    halve(piece, degree, left, right);
    exact_half.push_back(left);
    exact_half.push_back(right);
  }
  size = r_extent + z_extent;
}

}  // namespace catoptric::cad::meridian
