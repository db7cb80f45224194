#pragma once

#include <array>
#include <vector>

#include "cad/meridian_candidate.h"
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
  double z_min, z_max;    ///< of the poles, so of all its points
  double lo, hi;
  int span;
};

/// The pieces of a profile of one degree. Immutable, shared by all probes.
template <int Degree>
struct FastTable {
  explicit FastTable(const SpanTable& table);
  std::vector<FastPiece<Degree>> pieces;
  std::vector<Piece<double>> halvable;  ///< the same pieces, for the solver by halving
};

template <int Degree>
FastTable<Degree>::FastTable(const SpanTable& table) {
  constexpr std::size_t count = Degree + 1;
  for (const Piece<Quad>& half : table.exact_half) {
    if (table.spans[static_cast<std::size_t>(half.span)].is_point) continue;
    FastPiece<Degree> piece{};
    Piece<double> rough{
        {},          static_cast<double>(half.lo), static_cast<double>(half.width), half.span, half.free_lo,
        half.free_hi};
    std::array<Quad, count> r, z;
    for (std::size_t i = 0; i < count; ++i) {
      r[i] = half.curve.rw[i] / half.curve.w[i];
      z[i] = half.curve.zw[i] / half.curve.w[i];
      rough.curve.rw[i] = static_cast<double>(half.curve.rw[i]);
      rough.curve.zw[i] = static_cast<double>(half.curve.zw[i]);
      rough.curve.w[i] = static_cast<double>(half.curve.w[i]);
    }
    std::array<Quad, FastPiece<Degree>::size> rr{}, zz{}, z_mean{}, share_sum{};
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t j = 0; j < count; ++j) {
        const Quad share = Quad(product_binomials[Degree][i][j]) * half.curve.w[i] * half.curve.w[j];
        rr[i + j] += share * r[i] * r[j];
        zz[i + j] += share * z[i] * z[j];
        z_mean[i + j] += share * (z[i] + z[j]) / 2;
        share_sum[i + j] += share;
      }
    for (std::size_t k = 0; k < FastPiece<Degree>::size; ++k) {
      piece.rr[k] = static_cast<double>(rr[k] / share_sum[k]);
      piece.zz[k] = static_cast<double>(zz[k] / share_sum[k]);
      piece.z[k] = static_cast<double>(z_mean[k] / share_sum[k]);
    }
    piece.r0 = static_cast<double>(r[0]);
    piece.z0 = static_cast<double>(z[0]);
    piece.r1 = static_cast<double>(r[Degree]);
    piece.z1 = static_cast<double>(z[Degree]);
    piece.z_min = piece.z_max = piece.z0;
    for (const Quad& each : z) {
      piece.z_min = std::min(piece.z_min, static_cast<double>(each));
      piece.z_max = std::max(piece.z_max, static_cast<double>(each));
    }
    piece.lo = rough.lo;
    piece.hi = rough.lo + rough.width;
    piece.span = half.span;
    pieces.push_back(piece);
    halvable.push_back(rough);
  }
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

  /// The hits of the line, unordered, into candidates_; surely those that are wanted.
  void find(const Ray& ray, const NearRay& near, double beyond_mm, Wanted wanted) {
    ++counts_.rays;
    candidates_.clear();
    if (!near.passes(table_)) return;
    constexpr double generous = 1e-9;  // above any rounding of t: a cull may let a root pass, never lose one
    slack_ = generous * (table_.size + std::abs(near.shift));
    from_ = beyond_mm - near.shift - slack_;
    until_ = HUGE_VAL;
    wanted_ = wanted;
    const AxisLine<double> line(ray, near, table_);
    const bool horizontal = std::abs(line.dz) <= horizontal_slope * line.h;
    if (horizontal ? find_level(line, near) : find_crossings(line, near)) return;
    ++counts_.exact;
    find_exactly(table_, ray, near, candidates_);
  }

  /// Whether hits on a piece are known to be behind, or beyond the nearest hit so far, without computing
  /// them. Only for lines steep enough for the height to tell where along the line a point is.
  bool out_of_range(const AxisLine<double>& line, const FastPiece<Degree>& piece) const {
    if (std::abs(line.dz) < 0x1p-10) return false;
    const double a = (piece.z_min - line.oz) / line.dz, b = (piece.z_max - line.oz) / line.dz;
    return std::max(a, b) < from_ || std::min(a, b) > until_;
  }

  bool find_crossings(const AxisLine<double>& line, const NearRay& near);
  bool find_level(const AxisLine<double>& line, const NearRay& near);
  bool halve_and_solve(const AxisLine<double>& line, const NearRay& near, const Piece<double>& piece);

  void solve(const AxisLine<double>& line, const NearRay& near, int span, double lo, double hi, int sign_lo,
             double start) {
    const SpanForm& form = table_.spans[static_cast<std::size_t>(span)];
    const auto root = refine<double>(
        CrossingResidual<double>{line}, [&form](double s) { return evaluate<Degree>(form, s); }, lo, hi,
        sign_lo, start);
    const double t = distance_along(line, root.point.r, root.point.z);
    candidates_.push_back(make_candidate(near, t, root.s, root.point.r, root.point.z, span));
    if (wanted_ == Wanted::first && t >= from_ + 2 * slack_) until_ = std::min(until_, t + slack_);
  }

  const SpanTable& table_;
  const FastTable<Degree>& fast_;
  std::vector<Candidate> candidates_;
  std::vector<Bracket<double>> brackets_;
  double from_ = 0, until_ = 0, slack_ = 0;  ///< range of t in which hits are wanted
  Wanted wanted_ = Wanted::all;
};

/// @out   false when a piece is left that double cannot decide
template <int Degree>
bool FastProbe<Degree>::find_crossings(const AxisLine<double>& line, const NearRay& near) {
  using FP = FastPiece<Degree>;
  const double a = line.dz * line.dz, b = line.h * line.h, c = 2 * line.h * line.level;
  const double d = line.level * line.level + line.skew * line.skew;
  // Above every error bound of the solver by halving, at any depth: what is certain here is so there.
  const double error = 0x1p-41 * line.scale * line.scale;
  const CrossingResidual<double> residual{line};
  for (std::size_t number = 0; number < fast_.pieces.size(); ++number) {
    const FP& piece = fast_.pieces[number];
    std::array<double, FP::size> f;
    for (std::size_t i = 0; i < FP::size; ++i)
      f[i] = (a * piece.rr[i] - b * piece.zz[i]) - (c * piece.z[i] + d);
    double least = f[0], greatest = f[0], smallest = std::abs(f[0]);
    int variations = 0;
    for (std::size_t i = 1; i < FP::size; ++i) {
      least = std::min(least, f[i]);
      greatest = std::max(greatest, f[i]);
      smallest = std::min(smallest, std::abs(f[i]));
      variations += (f[i] < 0) != (f[i - 1] < 0);
    }
    if (least > error || greatest < -error || out_of_range(line, piece)) continue;
    if (smallest > error && variations == 1) {
      const double f0 = residual.value(piece.r0, piece.z0), f1 = residual.value(piece.r1, piece.z1);
      const double start = piece.lo + (piece.hi - piece.lo) * (f0 / (f0 - f1));
      solve(line, near, piece.span, piece.lo, piece.hi, f[0] < 0 ? -1 : 1, start);
    } else if (!halve_and_solve(line, near, fast_.halvable[number])) {
      return false;
    }
  }
  return true;
}

template <int Degree>
bool FastProbe<Degree>::halve_and_solve(const AxisLine<double>& line, const NearRay& near,
                                        const Piece<double>& piece) {
  ++counts_.halved;
  brackets_.clear();
  const CrossingForm<double> form{line};
  if (!Isolator<double, CrossingForm<double>>(form, Degree, brackets_).run(piece)) return false;
  for (const Bracket<double>& bracket : brackets_)
    solve(line, near, bracket.span, bracket.lo, bracket.hi, bracket.sign_lo, 0.5 * (bracket.lo + bracket.hi));
  return true;
}

template <int Degree>
bool FastProbe<Degree>::find_level(const AxisLine<double>& line, const NearRay& near) {
  brackets_.clear();
  const LevelForm<double> level{line, table_.z_extent};
  Isolator<double, LevelForm<double>> isolator(level, Degree, brackets_);
  for (const Piece<double>& piece : fast_.halvable)
    if (!isolator.run(piece)) return false;
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
