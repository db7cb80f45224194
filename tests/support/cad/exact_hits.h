#pragma once

#include <algorithm>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <vector>

#include "base/profile.h"
#include "base/ray.h"

namespace catoptric::test {

/// A hundred digits: the numbers of a profile and of a ray, as given, cost none of them.
using Exact =
    boost::multiprecision::number<boost::multiprecision::cpp_bin_float<100>, boost::multiprecision::et_off>;

/// A hit of the ray on the profile's spans, both taken as the exact numbers they are.
struct ExactHit {
  Exact distance;
  Exact x, y, z;       ///< on the ray
  Exact tr, tz;        ///< unit tangent of the generatrix there; (0, 0) where it has no speed
  double cosine = 1;   ///< of incidence
  bool touch = false;  ///< two roots nearer than 2^-90 of the span: a tangent ray
};

/// All hits by exact polynomials: along a span the distance from the axis and the height of the ray's points
/// meet where a polynomial of degree 2p in Bernstein form vanishes; its roots are isolated by Descartes' rule
/// of signs on halves of the span. Shares no arithmetic and no formula for the degree-p section with the
/// engines.
class ExactHits {
 public:
  explicit ExactHits(const Profile& profile) : profile_(profile) {}

  /// @out nearest first, distances > beyond
  std::vector<ExactHit> operator()(const Ray& ray, double beyond_mm = 0) const {
    std::vector<ExactHit> hits;
    const auto& spans = profile_.spans();
    for (std::size_t k = 0; k < spans.size(); ++k) meet(spans[k], k + 1 == spans.size(), ray, hits);
    std::erase_if(hits, [&](const ExactHit& hit) { return !(hit.distance > beyond_mm); });
    std::sort(hits.begin(), hits.end(),
              [](const ExactHit& a, const ExactHit& b) { return a.distance < b.distance; });
    return hits;
  }

 private:
  using Form = std::vector<Exact>;

  static Form product(const Form& a, const Form& b) {
    const int m = static_cast<int>(a.size()) - 1, n = static_cast<int>(b.size()) - 1;
    Form c(a.size() + b.size() - 1, Exact(0));
    for (int i = 0; i <= m; ++i)
      for (int j = 0; j <= n; ++j)
        c[static_cast<std::size_t>(i + j)] +=
            a[static_cast<std::size_t>(i)] * b[static_cast<std::size_t>(j)] * choose(m, i) * choose(n, j);
    for (int k = 0; k <= m + n; ++k) c[static_cast<std::size_t>(k)] /= choose(m + n, k);
    return c;
  }
  static Exact choose(int n, int k) {
    Exact value = 1;
    for (int i = 1; i <= k; ++i) value = value * (n - k + i) / i;
    return value;
  }
  static Exact value(Form form, const Exact& s) {
    for (std::size_t n = form.size() - 1; n > 0; --n)
      for (std::size_t i = 0; i < n; ++i) form[i] += s * (form[i + 1] - form[i]);
    return form[0];
  }

  struct Root {
    Exact s;
    bool touch;
  };

  /// Roots of a form over [lo, lo + width]; the upper end belongs to it where `closed`.
  static void isolate(Form form, const Exact& lo, const Exact& width, int depth, std::vector<Root>& roots) {
    constexpr int deepest = 300;
    // What vanishes at the lower end is a root there, of whatever multiplicity.
    if (form.front() == 0) {
      if (std::all_of(form.begin(), form.end(), [](const Exact& each) { return each == 0; })) return;
      roots.push_back({lo, false});
      std::size_t zeros = 0;
      while (form[zeros] == 0) ++zeros;
      // form = s^zeros q(s): Bernstein coefficients of q.
      const int n = static_cast<int>(form.size()) - 1, m = n - static_cast<int>(zeros);
      Form q;
      for (int i = 0; i <= m; ++i)
        q.push_back(form[static_cast<std::size_t>(i) + zeros] * choose(n, i + static_cast<int>(zeros)) /
                    choose(m, i));
      form = std::move(q);
    }
    if (form.size() < 2) return;
    int variations = 0, sign = 0;
    for (const Exact& each : form) {
      const int here = each.sign();
      if (here != 0 && sign != 0 && here != sign) ++variations;
      if (here != 0) sign = here;
    }
    if (variations == 0) return;
    if (variations == 1 && form.back() != 0) {
      roots.push_back({bisect(form, lo, width), false});
      return;
    }
    if (depth == deepest) {
      roots.push_back({lo + width / 2, true});
      return;
    }
    Form left(form.size()), right = form;
    left[0] = right[0];
    for (std::size_t level = 1; level < form.size(); ++level) {
      for (std::size_t i = 0; i + level < form.size(); ++i) right[i] = (right[i] + right[i + 1]) / 2;
      left[level] = right[0];
    }
    isolate(std::move(left), lo, width / 2, depth + 1, roots);
    isolate(std::move(right), lo + width / 2, width / 2, depth + 1, roots);
  }

  /// The one root between ends of unlike sign: Newton within the bracket.
  static Exact bisect(const Form& form, const Exact& lo, const Exact& width) {
    Form slope;
    for (std::size_t i = 0; i + 1 < form.size(); ++i) slope.push_back(form[i + 1] - form[i]);
    Exact a = 0, b = 1, x = form.front() / (form.front() - form.back());
    const int low_sign = form.front().sign();
    for (int i = 0; i < 400; ++i) {
      const Exact f = value(form, x);
      if (f == 0) break;
      (f.sign() == low_sign ? a : b) = x;
      const Exact next = x - f / (value(slope, x) * static_cast<int>(form.size() - 1));
      const Exact before = x;
      x = next > a && next < b ? next : (a + b) / 2;
      if (abs(x - before) <= std::ldexp(1.0, -300) * x) break;
    }
    return lo + width * x;
  }

  static void meet(const RationalSpan& span, bool last, const Ray& ray, std::vector<ExactHit>& hits) {
    const Exact dx = ray.direction.x(), dy = ray.direction.y(), dz = ray.direction.z();
    const Exact ox = ray.origin_mm.x(), oy = ray.origin_mm.y(), oz = ray.origin_mm.z();
    Form r, p, q, height;
    for (std::size_t i = 0; i < span.w.size(); ++i) {
      const Exact w = span.w[i], above = Exact(span.zw[i]) - oz * w;
      height.push_back(above);
      r.push_back(Exact(span.rw[i]) * dz);
      p.push_back(ox * dz * w + dx * above);
      q.push_back(oy * dz * w + dy * above);
    }
    Form form = height;
    if (dz != 0) {
      const Form rr = product(r, r), pp = product(p, p), qq = product(q, q);
      form.assign(rr.size(), Exact(0));
      for (std::size_t i = 0; i < rr.size(); ++i) form[i] = pp[i] + qq[i] - rr[i];
    }
    std::vector<Root> roots;
    isolate(form, 0, 1, 0, roots);
    if (last && form.back() == 0) roots.push_back({Exact(1), false});
    // Roots that no further halving tells apart are one touch.
    for (std::size_t i = 0; i < roots.size(); ++i) {
      const bool twin = i + 1 < roots.size() && roots[i + 1].s - roots[i].s < std::ldexp(1.0, -90);
      if (twin && roots[i].touch && roots[i + 1].touch) continue;
      add(span, roots[i].s, roots[i].touch || twin, ray, hits);
    }
  }

  static void add(const RationalSpan& span, const Exact& s, bool touch, const Ray& ray,
                  std::vector<ExactHit>& hits) {
    const auto form = [](const std::vector<double>& numbers) { return Form(numbers.begin(), numbers.end()); };
    const auto slope = [](const std::vector<double>& numbers) {
      Form f;
      for (std::size_t i = 0; i + 1 < numbers.size(); ++i) f.push_back(Exact(numbers[i + 1]) - numbers[i]);
      return f;
    };
    const Exact w = value(form(span.w), s), rw = value(form(span.rw), s), zw = value(form(span.zw), s);
    const Exact r = rw / w, z = zw / w;
    Exact tr = value(slope(span.rw), s) * w - rw * value(slope(span.w), s);
    Exact tz = value(slope(span.zw), s) * w - zw * value(slope(span.w), s);
    const Exact speed = sqrt(tr * tr + tz * tz);
    if (speed > 0) {
      tr /= speed;
      tz /= speed;
    }
    const Exact dx = ray.direction.x(), dy = ray.direction.y(), dz = ray.direction.z();
    const Exact ox = ray.origin_mm.x(), oy = ray.origin_mm.y(), oz = ray.origin_mm.z();
    const auto take = [&](const Exact& t, bool touches) {
      ExactHit hit{t, ox + t * dx, oy + t * dy, oz + t * dz, tr, tz, 1, touches};
      const Exact radius = sqrt(hit.x * hit.x + hit.y * hit.y);
      const Exact outward = radius > 0 ? (hit.x * dx + hit.y * dy) / radius : sqrt(dx * dx + dy * dy);
      hit.cosine = static_cast<double>(abs(tz * outward - tr * dz));
      hits.push_back(hit);
    };
    if (dz != 0) return take((z - oz) / dz, touch);
    const Exact a = dx * dx + dy * dy, b = ox * dx + oy * dy, c = ox * ox + oy * oy - r * r;
    const Exact discriminant = b * b - a * c;
    if (a == 0 || discriminant < 0) return;
    if (discriminant == 0) return take(-b / a, true);
    take((-b - sqrt(discriminant)) / a, touch);
    take((-b + sqrt(discriminant)) / a, touch);
  }

  const Profile& profile_;
};

}  // namespace catoptric::test
