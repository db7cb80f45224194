#pragma once

#include <array>
#include <vector>

#include "cad/meridian_batch.h"
#include "cad/meridian_candidate.h"
#include "cad/meridian_isolate.h"
#include "cad/meridian_pieces.h"
#include "cad/meridian_reflector.h"

namespace catoptric::cad::meridian {

/// Engine `meridian` for one degree.
template <int Degree>
class FastProbe final : public MeridianProbe {
 public:
  FastProbe(const SpanTable& table, const FastTable& fast) : table_(table), fast_(fast), batch_(table, fast) {
    const std::size_t most_hits = 2 * Degree * table.spans.size();
    candidates_.reserve(most_hits);
    brackets_.reserve(2 * Degree);
  }

  std::optional<Hit> first_hit(const Ray& ray, double beyond_mm) override {
    const NearRay near(ray, table_);
    find(ray, near, beyond_mm, Wanted::first);
    const Candidate* first = nullptr;
    for (const Candidate& candidate : candidates_)
      if (near.shift + candidate.t > beyond_mm && (first == nullptr || candidate.t < first->t))
        first = &candidate;
    if (first == nullptr) return std::nullopt;
    return make_hit(table_, near, *first);
  }

  void first_hits(std::span<const Ray> rays, double beyond_mm, std::span<std::optional<Hit>> hits) override {
    if (!meridian_works_side_by_side()) return Probe::first_hits(rays, beyond_mm, hits);
    for (std::size_t first = 0; first < rays.size(); first += BatchSolver::most_rays) {
      const std::size_t count = std::min(BatchSolver::most_rays, rays.size() - first);
      const auto& alone = batch_.solve(rays.subspan(first, count), beyond_mm, hits.subspan(first, count));
      for (std::size_t i = 0; i < count; ++i) {
        if (alone[i]) {
          hits[first + i] = first_hit(rays[first + i], beyond_mm);
        } else {
          ++counts_.rays;
          ++counts_.side_by_side;
        }
      }
    }
  }

  std::vector<Hit> all_hits(const Ray& ray, double beyond_mm) override {
    const NearRay near(ray, table_);
    find(ray, near, beyond_mm, Wanted::all);
    std::vector<Hit> hits;
    for (const Candidate& candidate : candidates_)
      if (near.shift + candidate.t > beyond_mm) hits.push_back(make_hit(table_, near, candidate));
    std::sort(hits.begin(), hits.end(),
              [](const Hit& a, const Hit& b) { return a.distance_mm < b.distance_mm; });
    return hits;
  }

 private:
  enum class Wanted { first, all };

  /// One line on its way through the pieces.
  struct Pass {
    const AxisLine<double>& line;
    const NearRay& near;
    Culler<double> culler;
    CrossingFactors<double> factors;
  };

  /// The hits of the line, unordered, into candidates_; surely those that are wanted.
  void find(const Ray& ray, const NearRay& near, double beyond_mm, Wanted wanted) {
    ++counts_.rays;
    candidates_.clear();
    if (!near.passes(table_)) return;
    const AxisLine<double> line(ray, near, table_);
    if (line.h == 0 && line.along == 0 && line.across == 0 && table_.axis_points_known) {  // the axis itself
      for (const AxisPoint& at : table_.axis_points)
        candidates_.push_back(make_candidate(near, (at.z - line.oz) / line.dz, at.s, 0, at.z, at.span));
      return;
    }
    wanted_ = wanted;
    Pass pass{line, near, {}, {}};
    pass.culler.set(line, near.shift, beyond_mm, table_.size);
    pass.factors.set(line);
    const bool horizontal = std::abs(line.dz) <= horizontal_slope * line.h;
    if (horizontal ? find_level(line, near) : find_crossings(pass)) return;
    ++counts_.exact;
    find_exactly(table_, ray, near, candidates_);
  }

  bool find_crossings(Pass& pass);
  bool find_level(const AxisLine<double>& line, const NearRay& near);
  bool look_at(Pass& pass, std::size_t number);
  bool halve_and_solve(Pass& pass, const Piece<double>& piece);
  void solve(Pass& pass, int span, double lo, double hi, int sign_lo, double start);

  const SpanTable& table_;
  const FastTable& fast_;
  BatchSolver batch_;
  std::vector<Candidate> candidates_;
  std::vector<Bracket<double>> brackets_;
  Wanted wanted_ = Wanted::all;
};

/// @out   false when a piece is left that double cannot decide
template <int Degree>
bool FastProbe<Degree>::find_crossings(Pass& pass) {
  if (fast_.tree.empty()) {
    for (std::size_t i = 0; i < fast_.top; ++i)
      if (!look_at(pass, i)) return false;
    return true;
  }
  for (std::size_t n = 0; n < fast_.tree.size();) {
    const CullNode& node = fast_.tree[n];
    if (pass.culler.misses(pass.line, node)) {
      n = node.skip;
      continue;
    }
    if (node.leaf)
      for (std::size_t i = node.first; i < node.last; ++i)
        if (!look_at(pass, i)) return false;
    ++n;
  }
  return true;
}

template <int Degree>
bool FastProbe<Degree>::look_at(Pass& pass, std::size_t number) {
  const FastPiece& piece = fast_.pieces[number];
  constexpr std::size_t size = 2 * Degree + 1;
  std::array<double, size> f;
  for (std::size_t i = 0; i < size; ++i) f[i] = pass.factors.coefficient(piece, i);
  const double error = pass.factors.error;
  double least = f[0], greatest = f[0], smallest = std::abs(f[0]);
  int variations = 0;
  for (std::size_t i = 1; i < size; ++i) {
    least = std::min(least, f[i]);
    greatest = std::max(greatest, f[i]);
    smallest = std::min(smallest, std::abs(f[i]));
    variations += (f[i] < 0) != (f[i - 1] < 0);
  }
  if (least > error || greatest < -error || pass.culler.misses(pass.line, piece.ring)) return true;
  if (!(smallest > error && variations == 1)) {
    if (piece.child == 0) return halve_and_solve(pass, fast_.halvable[number]);
    return look_at(pass, piece.child) && look_at(pass, piece.child + 1);
  }
  const CrossingResidual<double> residual{pass.line};
  const double f0 = residual.value(piece.r0, piece.z0), f1 = residual.value(piece.r1, piece.z1);
  const double start = piece.lo + (piece.hi - piece.lo) * (f0 / (f0 - f1));
  solve(pass, piece.span, piece.lo, piece.hi, f[0] < 0 ? -1 : 1, start);
  return true;
}

template <int Degree>
void FastProbe<Degree>::solve(Pass& pass, int span, double lo, double hi, int sign_lo, double start) {
  const SpanForm& form = table_.spans[static_cast<std::size_t>(span)];
  const auto at = [&form](double s) { return evaluate<Degree>(form, s); };
  const auto root = refine<double>(CrossingResidual<double>{pass.line}, at, lo, hi, sign_lo, start);
  const double t = distance_along(pass.line, root.point.r, root.point.z);
  candidates_.push_back(make_candidate(pass.near, t, root.s, root.point.r, root.point.z, span));
  if (wanted_ == Wanted::first) pass.culler.found(t);
}

template <int Degree>
bool FastProbe<Degree>::halve_and_solve(Pass& pass, const Piece<double>& piece) {
  ++counts_.halved;
  brackets_.clear();
  const CrossingForm<double> form{pass.line};
  if (!Isolator<double, CrossingForm<double>>(form, Degree, brackets_).run(piece)) return false;
  for (const Bracket<double>& bracket : brackets_)
    solve(pass, bracket.span, bracket.lo, bracket.hi, bracket.sign_lo, 0.5 * (bracket.lo + bracket.hi));
  return true;
}

template <int Degree>
bool FastProbe<Degree>::find_level(const AxisLine<double>& line, const NearRay& near) {
  brackets_.clear();
  const LevelForm<double> level{line, table_.z_extent};
  Isolator<double, LevelForm<double>> isolator(level, Degree, brackets_);
  for (std::size_t i = 0; i < fast_.top; ++i)
    if (!isolator.run(fast_.halvable[i])) return false;
  for (const Bracket<double>& bracket : brackets_) {
    const SpanForm& form = table_.spans[static_cast<std::size_t>(bracket.span)];
    const auto root = refine<double>(
        LevelResidual<double>{line}, [&form](double s) { return evaluate<Degree>(form, s); }, bracket.lo,
        bracket.hi, bracket.sign_lo, 0.5 * (bracket.lo + bracket.hi));
    const double off = root.point.r - line.across;
    if (std::abs(off) <= 64 * Precision<double>::unit_roundoff * table_.size) return false;
    if (off < 0) continue;
    const double side = std::sqrt(off * (root.point.r + line.across));
    for (const double t : {(-side - line.along) / line.h, (side - line.along) / line.h})
      candidates_.push_back(make_candidate(near, t, root.s, root.point.r, root.point.z, bracket.span));
  }
  return true;
}

}  // namespace catoptric::cad::meridian
