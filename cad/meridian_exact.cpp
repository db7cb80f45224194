#include <algorithm>

#include "cad/meridian_candidate.h"
#include "cad/meridian_isolate.h"

namespace catoptric::cad::meridian {
namespace {

using QuadLine = AxisLine<Quad>;
using QuadBracket = Bracket<Quad>;

template <typename Form>
std::vector<QuadBracket> isolate(const SpanTable& table, const Form& form) {
  std::vector<QuadBracket> brackets;
  Isolator<Quad, Form> isolator(form, table.degree, brackets);
  for (const Piece<Quad>& span : table.exact)
    if (!table.spans[static_cast<std::size_t>(span.span)].is_point) isolator.run(span);
  return brackets;
}

/// Where in a bracket the hit is; a cluster on the axis is the vertex itself.
template <typename Function>
Root<Quad> locate(const SpanTable& table, const Function& function, const QuadBracket& bracket) {
  const Piece<Quad>& span = table.exact[static_cast<std::size_t>(bracket.span)];
  const auto at = [&](Quad s) { return evaluate(span, table.degree, s); };
  if (bracket.cluster) {
    for (const Quad end : {bracket.lo, bracket.hi})
      if (const auto point = at(end); point.r == 0) return {end, point};
  } else {
    if (bracket.sign_lo == 0) return {bracket.lo, at(bracket.lo)};
    if (bracket.sign_hi == 0) return {bracket.hi, at(bracket.hi)};
    return refine<Quad>(function, at, bracket.lo, bracket.hi, bracket.sign_lo, (bracket.lo + bracket.hi) / 2);
  }
  const Quad middle = (bracket.lo + bracket.hi) / 2;
  return {middle, at(middle)};
}

/// Collects hits; touches only where nothing else is, and only if the line really comes to the surface.
class Collector {
 public:
  Collector(const SpanTable& table, const QuadLine& line, std::vector<Candidate>& out)
      : table_(table), line_(line), out_(out) {}

  void add(Quad t, const Root<Quad>& root, const QuadBracket& bracket) {
    const bool touch = bracket.cluster && bracket.sign_lo == bracket.sign_hi;
    const Candidate candidate{static_cast<double>(t), static_cast<double>(root.s),
                              static_cast<double>(root.point.r), static_cast<double>(root.point.z),
                              bracket.span};
    if (!touch)
      out_.push_back(candidate);
    else if (comes_near(t, root.point))
      touches_.push_back(candidate);
  }

  void finish() {
    const double same = 64 * Precision<double>::unit_roundoff * table_.size;
    for (const Candidate& touch : touches_)
      if (std::none_of(out_.begin(), out_.end(),
                       [&](const Candidate& other) { return std::abs(other.t - touch.t) <= same; }))
        out_.push_back(touch);
  }

 private:
  bool comes_near(Quad t, const CurvePoint<Quad>& point) const {
    const Quad x = line_.ox + t * line_.dx, y = line_.oy + t * line_.dy, z = line_.oz + t * line_.dz;
    const Quad off_r = square_root(x * x + y * y) - point.r, off_z = z - point.z;
    const Quad rounding = Quad(8 * Precision<double>::unit_roundoff * table_.size);
    return absolute(off_r) <= rounding && absolute(off_z) <= rounding;
  }

  const SpanTable& table_;
  const QuadLine& line_;
  std::vector<Candidate>& out_;
  std::vector<Candidate> touches_;
};

void find_level_hits(const SpanTable& table, const QuadLine& line, Collector& collector) {
  const LevelForm<Quad> form{line, table.z_extent};
  for (QuadBracket bracket : isolate(table, form)) {
    const Root<Quad> root = locate(table, LevelResidual<Quad>{line}, bracket);
    const Quad squared = (root.point.r - line.across) * (root.point.r + line.across);
    const Quad noise = Quad(64) * Precision<Quad>::unit_roundoff * Quad(table.size) * Quad(table.size);
    if (squared < -noise) continue;
    if (squared <= noise) {  // the line touches the circle at this height
      bracket.cluster = true;
      bracket.sign_lo = bracket.sign_hi = 1;
      collector.add(-line.along / line.h, root, bracket);
      continue;
    }
    const Quad side = square_root(squared);
    collector.add((-side - line.along) / line.h, root, bracket);
    collector.add((side - line.along) / line.h, root, bracket);
  }
}

}  // namespace

void find_exactly(const SpanTable& table, const Ray& ray, const NearRay& near, std::vector<Candidate>& out) {
  out.clear();
  const QuadLine line(ray, near, table);
  Collector collector(table, line, out);
  if (absolute(line.dz) <= Quad(horizontal_slope) * line.h) {
    find_level_hits(table, line, collector);
  } else {
    const CrossingForm<Quad> form{line};
    for (const QuadBracket& bracket : isolate(table, form)) {
      const Root<Quad> root = locate(table, CrossingResidual<Quad>{line}, bracket);
      collector.add(distance_along<Quad>(line, root.point.r, root.point.z), root, bracket);
    }
  }
  collector.finish();
}

}  // namespace catoptric::cad::meridian
