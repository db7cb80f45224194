#pragma once

#include <array>
#include <vector>

#include "cad/meridian_candidate.h"
#include "cad/meridian_cull.h"
#include "cad/meridian_isolate.h"
#include "cad/meridian_reflector.h"

namespace catoptric::cad::meridian {

/// A piece with the coefficients of F / W^2 split by what the ray contributes:
/// F / W^2 = dz^2 R^2 - h^2 Z^2 - 2 h level Z - (level^2 + skew^2).
/// @from  Bernstein product, Farin, 5th ed., section 5.9; normalised as in Coefficients
template <int Degree>
struct FastPiece {
  static constexpr std::size_t size = 2 * Degree + 1;
  std::array<double, size> rr, zz, z;
  double r0, z0, r1, z1;  ///< the ends
  CullNode ring;          ///< of the poles, so of all its points
  double lo, hi;
  int span;
  std::size_t child;  ///< its lower half; the upper one follows. 0: not halved in advance
};

/// The pieces of a profile of one degree: spans cut in two, and these halved in advance, for lines that meet
/// a piece more than once or graze it. Immutable, shared by all probes.
template <int Degree>
struct FastTable {
  explicit FastTable(const SpanTable& table);
  std::vector<FastPiece<Degree>> pieces;
  std::vector<Piece<double>> halvable;  ///< the same pieces, for the solver by halving
  std::size_t top = 0;                  ///< the first `top` pieces make up the generatrix
  std::vector<CullNode> tree;           ///< over these
};

/// In double: the roundings are far below the certainty that look_at asks for.
template <int Degree>
FastPiece<Degree> make_fast_piece(const Piece<double>& from) {
  constexpr std::size_t count = Degree + 1;
  FastPiece<Degree> piece{};
  std::array<double, count> r, z;
  piece.ring = {HUGE_VAL, -HUGE_VAL, HUGE_VAL, -HUGE_VAL, 0, 0, 0, true};
  for (std::size_t i = 0; i < count; ++i) {
    r[i] = from.curve.rw[i] / from.curve.w[i];
    z[i] = from.curve.zw[i] / from.curve.w[i];
    piece.ring.r_min = std::min(piece.ring.r_min, r[i]);
    piece.ring.r_max = std::max(piece.ring.r_max, r[i]);
    piece.ring.z_min = std::min(piece.ring.z_min, z[i]);
    piece.ring.z_max = std::max(piece.ring.z_max, z[i]);
  }
  std::array<double, FastPiece<Degree>::size> shares{};
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = 0; j < count; ++j) {
      const double share = product_binomials[Degree][i][j] * from.curve.w[i] * from.curve.w[j];
      piece.rr[i + j] += share * r[i] * r[j];
      piece.zz[i + j] += share * z[i] * z[j];
      piece.z[i + j] += share * 0.5 * (z[i] + z[j]);
      shares[i + j] += share;
    }
  for (std::size_t k = 0; k < FastPiece<Degree>::size; ++k) {
    piece.rr[k] /= shares[k];
    piece.zz[k] /= shares[k];
    piece.z[k] /= shares[k];
  }
  piece.r0 = r[0];
  piece.z0 = z[0];
  piece.r1 = r[Degree];
  piece.z1 = z[Degree];
  piece.lo = from.lo;
  piece.hi = from.lo + from.width;
  piece.span = from.span;
  return piece;
}

template <int Degree>
FastTable<Degree>::FastTable(const SpanTable& table) {
  for (const Piece<Quad>& half : table.exact_half)
    if (!table.spans[static_cast<std::size_t>(half.span)].is_point) halvable.push_back(rounded(half));
  top = halvable.size();
  constexpr std::size_t levels = 3;  // measured: a fourth gains 1 %
  std::vector<std::size_t> children;
  for (std::size_t level = 0, first = 0; level < levels; ++level) {
    const std::size_t last = halvable.size();
    for (; first < last; ++first) {
      children.push_back(halvable.size());
      Piece<double> left, right;
      halve(halvable[first], Degree, left, right);
      halvable.push_back(left);
      halvable.push_back(right);
    }
  }
  children.resize(halvable.size(), 0);
  std::vector<CullNode> rings;
  for (std::size_t i = 0; i < halvable.size(); ++i) {
    pieces.push_back(make_fast_piece<Degree>(halvable[i]));
    pieces.back().child = children[i];
    if (i < top) rings.push_back(pieces.back().ring);
  }
  tree = build_cull_tree(rings);
}

/// Engine `meridian` for one degree.
template <int Degree>
class FastProbe final : public MeridianProbe {
 public:
  FastProbe(const SpanTable& table, const FastTable<Degree>& fast) : table_(table), fast_(fast) {
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
    Pass(const AxisLine<double>& axis_line, const NearRay& near_ray, double beyond_mm, double slack)
        : line(axis_line),
          near(near_ray),
          culler(line, beyond_mm - near.shift - slack, HUGE_VAL, slack),
          rr(line.dz * line.dz),
          zz(line.h * line.h),
          z(2 * line.h * line.level),
          constant(line.level * line.level + line.skew * line.skew),
          error(0x1p-41 * line.scale * line.scale) {}
    const AxisLine<double>& line;
    const NearRay& near;
    Culler culler;
    double rr, zz, z, constant;  ///< factors of FastPiece's coefficients
    double
        error;  ///< above every bound of the solver by halving, at any depth: certain here is certain there
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
    constexpr double generous = 1e-9;  // far above any rounding of t, see Culler
    Pass pass(line, near, beyond_mm, generous * (table_.size + std::abs(near.shift)));
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
  const FastTable<Degree>& fast_;
  std::vector<Candidate> candidates_;
  std::vector<Bracket<double>> brackets_;
  Wanted wanted_ = Wanted::all;
};

/// @out   false when a piece is left that double cannot decide
template <int Degree>
bool FastProbe<Degree>::find_crossings(Pass& pass) {
  constexpr std::size_t few = 4;  // pieces for which a tree does not pay
  if (fast_.top <= few) {
    for (std::size_t i = 0; i < fast_.top; ++i)
      if (!look_at(pass, i)) return false;
    return true;
  }
  for (std::size_t n = 0; n < fast_.tree.size();) {
    const CullNode& node = fast_.tree[n];
    if (pass.culler.misses(node)) {
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
  using FP = FastPiece<Degree>;
  const FP& piece = fast_.pieces[number];
  std::array<double, FP::size> f;
  for (std::size_t i = 0; i < FP::size; ++i)
    f[i] = (pass.rr * piece.rr[i] - pass.zz * piece.zz[i]) - (pass.z * piece.z[i] + pass.constant);
  double least = f[0], greatest = f[0], smallest = std::abs(f[0]);
  int variations = 0;
  for (std::size_t i = 1; i < FP::size; ++i) {
    least = std::min(least, f[i]);
    greatest = std::max(greatest, f[i]);
    smallest = std::min(smallest, std::abs(f[i]));
    variations += (f[i] < 0) != (f[i - 1] < 0);
  }
  if (least > pass.error || greatest < -pass.error || pass.culler.misses(piece.ring)) return true;
  if (!(smallest > pass.error && variations == 1)) {
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
