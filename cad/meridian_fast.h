#pragma once

#include <array>
#include <vector>

#include "base/float_traps.h"
#include "cad/meridian_batch.h"
#include "cad/meridian_blocks.h"
#include "cad/meridian_candidate.h"
#include "cad/meridian_crossing.h"
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
    waiting_.reserve(most_hits);
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
    BlockQuery<2> query;
  };

  /// A piece crossed once, from `from` on along the line.
  struct Waiting {
    std::array<double, 2 * Degree + 1> f;
    double from;
    const FastPiece* piece;
  };

  /// What visit_blocks tells.
  struct Sink {
    FastProbe& probe;
    Pass& pass;

    CATOPTRIC_FORCE_INLINE void crosses(const FastPiece& piece, const Crossings& crossings,
                                        std::size_t lane) {
      auto& waiting = probe.waiting_;
      const double from = crossings.from[lane];
      if (probe.wanted_ == Wanted::first) {
        if (from > pass.culler.until) return;
        pass.culler.found(from, crossings.until[lane]);
        while (!waiting.empty() && waiting.back().from > pass.culler.until) waiting.pop_back();
      }
      Waiting& added = waiting.emplace_back();
      for (std::size_t i = 0; i <= 2 * Degree; ++i) added.f[i] = crossings.f[i][lane];
      added.from = from;
      added.piece = &piece;
    }
    double until() const { return pass.culler.until; }
    bool doubts(std::size_t piece) { return probe.halve_and_solve(pass, probe.fast_.halvable[piece]); }
  };

  /// The hits of the line, unordered, into candidates_; surely those that are wanted.
  void find(const Ray& ray, const NearRay& near, double beyond_mm, Wanted wanted) {
    const UntrappedFloats untrapped;  // the doubts of double, infinite ones included, go to find_exactly
    ++counts_.rays;
    candidates_.clear();
    if (!near.passes(table_)) return;
    const AxisLine<double> line(ray, near, table_);
    if (line.h == 0 && line.along == 0 && line.across == 0 && table_.axis_points_known) {  // the axis itself
      if (line.dz == 0) return;  // or no direction at all
      for (const AxisPoint& at : table_.axis_points)
        candidates_.push_back(make_candidate(near, (at.z - line.oz) / line.dz, at.s, 0, at.z, at.span));
      return;
    }
    wanted_ = wanted;
    Pass pass{line, near, {}, {}};
    CrossingFactors<double> factors;
    factors.set(line);
    pass.culler.set(line, near.shift, beyond_mm, table_.size);
    const auto itself = [](auto of) { return of; };
    pass.query.set(line, pass.culler, factors, itself, itself);
    const bool horizontal = std::abs(line.dz) <= horizontal_slope * line.h;
    if (horizontal ? find_level(line, near) : find_crossings(pass)) return;
    ++counts_.exact;
    find_exactly(table_, ray, near, candidates_);
  }

  bool find_crossings(Pass& pass);
  bool find_level(const AxisLine<double>& line, const NearRay& near);
  bool halve_and_solve(Pass& pass, const Piece<double>& piece);
  bool solve_swiftly(Pass& pass, const FastPiece& piece, std::array<double, 2 * Degree + 1>& f);
  void add(Pass& pass, int span, double s, double r, double z);
  void solve(Pass& pass, int span, double lo, double hi, int sign_lo, double start);

  const SpanTable& table_;
  const FastTable& fast_;
  BatchSolver batch_;
  std::vector<Candidate> candidates_;
  std::vector<Waiting> waiting_;
  std::vector<Bracket<double>> brackets_;
  Wanted wanted_ = Wanted::all;
};

/// @out   false when a piece is left that double cannot decide
template <int Degree>
bool FastProbe<Degree>::find_crossings(Pass& pass) {
  waiting_.clear();
  Sink sink{*this, pass};
  if (!visit_blocks<2>(fast_, pass.query, Degree, sink)) return false;
  for (Waiting& crossing : waiting_) {
    if (crossing.from > pass.culler.until) continue;
    const FastPiece& piece = *crossing.piece;
    const int sign_lo = crossing.f[0] < 0 ? -1 : 1;
    if (!solve_swiftly(pass, piece, crossing.f))
      solve(pass, piece.span, piece.lo, piece.hi, sign_lo, 0.5 * (piece.lo + piece.hi));
  }
  return true;
}

template <int Degree>
bool FastProbe<Degree>::solve_swiftly(Pass& pass, const FastPiece& piece,
                                      std::array<double, 2 * Degree + 1>& f) {
  CrossingNewton<double> newton;
  newton.set_line(pass.line);
  newton.begin(f, piece.lo, piece.hi, Degree);
  const HalfSpan<double>& half = fast_.halves[piece.half];
  for (int i = 0; i < newton.most_steps && newton.active; ++i) newton.step(half, Degree);
  newton.finish(half, Degree);
  if (newton.failed) return false;
  add(pass, piece.span, newton.s, newton.r, newton.z);
  return true;
}

template <int Degree>
void FastProbe<Degree>::add(Pass& pass, int span, double s, double r, double z) {
  const double t = distance_along(pass.line, r, z);
  candidates_.push_back(make_candidate(pass.near, t, s, r, z, span));
  if (wanted_ != Wanted::first) return;
  pass.culler.found(t);
}

template <int Degree>
void FastProbe<Degree>::solve(Pass& pass, int span, double lo, double hi, int sign_lo, double start) {
  const SpanForm& form = table_.spans[static_cast<std::size_t>(span)];
  const auto at = [&form](double s) { return evaluate<Degree>(form, s); };
  const auto root = refine<double>(CrossingResidual<double>{pass.line}, at, lo, hi, sign_lo, start);
  add(pass, span, root.s, root.point.r, root.point.z);
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
