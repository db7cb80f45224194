#include "cad/meridian_batch.h"

#include <algorithm>

#include "base/vector_clones.h"
#include "cad/meridian_batch_refine.h"
#include "cad/meridian_batch_work.h"
#include "cad/meridian_candidate.h"
#include "cad/meridian_isolate.h"
#include "cad/meridian_reflector.h"

/// For lambdas that become part of code under CATOPTRIC_VECTOR_CLONES.
#define FORCE_INLINE __attribute__((always_inline))

namespace catoptric::cad::meridian {
namespace {

constexpr std::size_t groups = BatchSolver::most_rays / lane_count;

/// Newton runs on two sets of lanes in turn, so that one's divisions fill the other's waiting.
constexpr std::size_t chains = 2;
constexpr std::size_t jobs_at_once = chains * lane_count;

CATOPTRIC_VECTOR_CLONES void set_groups(const SpanTable& table, std::span<const Ray> rays, double beyond_mm,
                                        RayGroup* group) {
  for (std::size_t first = 0; first < rays.size(); first += lane_count, ++group) {
    const Ray* ray[lane_count];
    for (std::size_t k = 0; k < lane_count; ++k) ray[k] = &rays[std::min(first + k, rays.size() - 1)];
    const auto origin = [&](int axis) FORCE_INLINE {
      return gather([&](std::size_t k) { return ray[k]->origin_mm[axis]; });
    };
    const auto direction = [&](int axis) FORCE_INLINE {
      return gather([&](std::size_t k) { return ray[k]->direction[axis]; });
    };
    NearRays<Lanes>& near = group->near;
    near.set(origin(0), origin(1), origin(2), direction(0), direction(1), direction(2), table);
    group->line = AxisLine<Lanes>(near, table);
    const AxisLine<Lanes>& line = group->line;
    group->culler.set(line, near.shift, beyond_mm, table.size);
    group->factors.set(line);
    const Lanes zero = Lanes(0);
    const Mask on_axis = (line.h == zero) & (line.along == zero) & (line.across == zero);
    const Mask level = absolute(line.dz) <= horizontal_slope * line.h;
    const Mask near_part = near.passes(table);
    group->alone = near_part & (on_axis | level);
    group->open = near_part & ~group->alone;
    for (std::size_t k = rays.size() - first; k < lane_count; ++k) group->open.set(k, false);
  }
}

/// Where the rays of a group certainly cross the generatrix once, piece by piece.
class CrossingFinder {
 public:
  CrossingFinder(const FastTable& fast, std::size_t last, RayGroup& group, std::size_t first_ray,
                 std::vector<CrossingJob>& jobs)
      : fast_(fast), last_(last), group_(group), first_ray_(first_ray), jobs_(jobs) {}

  CATOPTRIC_FORCE_INLINE void run() {
    if (fast_.tree.empty()) {
      for (std::size_t i = 0; i < fast_.top; ++i) look_at(i, group_.open);
      return;
    }
    for (std::size_t n = 0; n < fast_.tree.size();) {
      const CullNode& node = fast_.tree[n];
      const Mask met = group_.open & ~group_.culler.misses(group_.line, node);
      if (!any(met)) {
        n = node.skip;
        continue;
      }
      if (node.leaf)
        for (std::size_t i = node.first; i < node.last; ++i) look_at(i, met);
      ++n;
    }
  }

 private:
  struct Visit {
    std::size_t piece;
    Mask rays;
  };

  /// A piece, and its halves for the rays that want them.
  CATOPTRIC_FORCE_INLINE void look_at(std::size_t number, const Mask& rays) {
    Visit stack[FastTable::most_levels + 1];  // one sibling waits on each level
    std::size_t size = 1;
    stack[0] = {number, rays};
    while (size > 0) {
      const Visit visit = stack[--size];
      const FastPiece& piece = fast_.pieces[visit.piece];
      const Mask doubtful = judge(visit.piece, piece, visit.rays);
      if (!any(doubtful)) continue;
      if (piece.child == 0) {
        group_.alone |= doubtful;
        group_.open &= ~doubtful;
        continue;
      }
      stack[size++] = {piece.child + 1, doubtful};
      stack[size++] = {piece.child, doubtful};
    }
  }

  /// Notes the rays that cross the piece once.
  /// @out   those whose crossings the signs do not tell
  CATOPTRIC_FORCE_INLINE Mask judge(std::size_t number, const FastPiece& piece, const Mask& rays) {
    const CrossingFactors<Lanes>& factors = group_.factors;
    std::array<Lanes, most_coefficients> f;
    f[0] = factors.coefficient(piece, 0);
    Lanes least = f[0], greatest = f[0];
    for (std::size_t i = 1; i <= last_; ++i) {
      f[i] = factors.coefficient(piece, i);
      least = lesser_of(least, f[i]);
      greatest = greater_of(greatest, f[i]);
    }
    Mask left = rays & group_.open & ~((least > factors.error) | (greatest < -factors.error));
    if (!any(left)) return left;
    left &= ~group_.culler.misses(group_.line, piece.ring);
    if (!any(left)) return left;
    const Lanes zero = Lanes(0);
    Lanes smallest = absolute(f[0]);
    Mask before = f[0] < zero, changed = before != before, again = changed;
    for (std::size_t i = 1; i <= last_; ++i) {
      smallest = lesser_of(smallest, absolute(f[i]));
      const Mask below = f[i] < zero, changes = below != before;
      again |= changed & changes;
      changed |= changes;
      before = below;
    }
    const Mask once = left & (smallest > factors.error) & changed & ~again;
    if (any(once)) note(number, piece, f[0], once);
    return left & ~once;
  }

  CATOPTRIC_FORCE_INLINE void note(std::size_t number, const FastPiece& piece, const Lanes& front,
                                   const Mask& once) {
    const CrossingResidual<Lanes> residual{group_.line};
    const Lanes f0 = residual.value(Lanes(piece.r0), Lanes(piece.z0));
    const Lanes f1 = residual.value(Lanes(piece.r1), Lanes(piece.z1));
    const Lanes start = piece.lo + (piece.hi - piece.lo) * (f0 / (f0 - f1));
    for (std::size_t k = 0; k < lane_count; ++k)
      if (once[k]) jobs_.push_back({start[k], front[k] < 0 ? -1.0 : 1.0, number, first_ray_ + k});
  }

  const FastTable& fast_;
  std::size_t last_;
  RayGroup& group_;
  std::size_t first_ray_;
  std::vector<CrossingJob>& jobs_;
};

CATOPTRIC_VECTOR_CLONES void find_crossings(const FastTable& fast, std::size_t degree, RayGroup* group,
                                            std::size_t rays, std::vector<CrossingJob>& jobs) {
  for (std::size_t first = 0; first < rays; first += lane_count, ++group)
    CrossingFinder(fast, 2 * degree, *group, first, jobs).run();
}

/// Four jobs made ready for Newton.
class JobLoader {
 public:
  JobLoader(const SpanTable& table, const FastTable& fast, const RayGroup* group, const CrossingJob* jobs)
      : table_(table), fast_(fast), group_(group), jobs_(jobs) {}

  CATOPTRIC_FORCE_INLINE void load(NewtonLanes& newton) const {
    const FastPiece* piece[lane_count];
    const SpanForm* span[lane_count];
    for (std::size_t k = 0; k < lane_count; ++k) {
      piece[k] = &fast_.pieces[jobs_[k].piece];
      span[k] = &table_.spans[static_cast<std::size_t>(piece[k]->span)];
      newton.halves.lower.set(k, piece[k]->hi <= 0.5);
    }
    newton.lo = gather([&](std::size_t k) FORCE_INLINE { return piece[k]->lo; });
    newton.hi = gather([&](std::size_t k) FORCE_INLINE { return piece[k]->hi; });
    newton.s = gather([&](std::size_t k) FORCE_INLINE { return jobs_[k].start; });
    newton.sign_lo = gather([&](std::size_t k) FORCE_INLINE { return jobs_[k].sign_lo; });
    const std::size_t degree = static_cast<std::size_t>(table_.degree);
    for (std::size_t i = 0; i <= degree; ++i) {
      std::size_t at[lane_count];
      for (std::size_t k = 0; k < lane_count; ++k) at[k] = newton.halves.lower[k] ? i : degree - i;
      newton.halves.rw[i] = gather([&](std::size_t k) FORCE_INLINE { return span[k]->rw[at[k]]; });
      newton.halves.zw[i] = gather([&](std::size_t k) FORCE_INLINE { return span[k]->zw[at[k]]; });
      newton.halves.w[i] = gather([&](std::size_t k) FORCE_INLINE { return span[k]->w[at[k]]; });
    }
    load_line(newton.line);
    newton.begin(degree);
  }

  /// About t, see nearest_along.
  CATOPTRIC_FORCE_INLINE Lanes nearest(const NewtonLanes& newton) const {
    const CurvePoint<Lanes>& p = newton.point;
    const DistanceAlong<Lanes> distance{newton.line, p.r, p.z};
    const Lanes t = choose(distance.by_height_is_better(), distance.by_height(), distance.by_radius());
    NearRays<Lanes> near;
    near.ox = newton.line.ox;
    near.oy = newton.line.oy;
    near.oz = newton.line.oz;
    near.dx = newton.line.dx;
    near.dy = newton.line.dy;
    near.dz = newton.line.dz;
    return nearest_along(near, t, p.r, p.z);
  }

 private:
  CATOPTRIC_FORCE_INLINE void load_line(AxisLine<Lanes>& line) const {
    const AxisLine<Lanes>* from[lane_count];
    std::size_t lane[lane_count];
    for (std::size_t k = 0; k < lane_count; ++k) {
      from[k] = &group_[jobs_[k].ray / lane_count].line;
      lane[k] = jobs_[k].ray % lane_count;
    }
    const auto take = [&](Lanes AxisLine<Lanes>::*member) FORCE_INLINE {
      line.*member = gather([&](std::size_t k) FORCE_INLINE { return (from[k]->*member)[lane[k]]; });
    };
    take(&AxisLine<Lanes>::ox);
    take(&AxisLine<Lanes>::oy);
    take(&AxisLine<Lanes>::oz);
    take(&AxisLine<Lanes>::dx);
    take(&AxisLine<Lanes>::dy);
    take(&AxisLine<Lanes>::dz);
    take(&AxisLine<Lanes>::h);
    take(&AxisLine<Lanes>::along);
    take(&AxisLine<Lanes>::across);
    take(&AxisLine<Lanes>::level);
    take(&AxisLine<Lanes>::skew);
    take(&AxisLine<Lanes>::scale);
  }

  const SpanTable& table_;
  const FastTable& fast_;
  const RayGroup* group_;
  const CrossingJob* jobs_;
};

/// @in    jobs filled up to a multiple of `jobs_at_once`, of which the first `count` matter
CATOPTRIC_VECTOR_CLONES void refine_crossings(const SpanTable& table, const FastTable& fast, RayGroup* group,
                                              double beyond_mm, std::span<const CrossingJob> jobs,
                                              std::size_t count, NearestHits& nearest) {
  constexpr int most_steps = 16;  // four are usual
  const std::size_t degree = static_cast<std::size_t>(table.degree);
  NewtonLanes newton[chains];
  for (std::size_t first = 0; first < count; first += jobs_at_once) {
    for (std::size_t c = 0; c < chains; ++c)
      JobLoader(table, fast, group, &jobs[first + c * lane_count]).load(newton[c]);
    for (int step = 0; step < most_steps; ++step) {
      bool more = false;
      for (std::size_t c = 0; c < chains; ++c) more |= newton[c].step(degree);
      if (!more) break;
    }
    for (std::size_t c = 0; c < chains; ++c) {
      const std::size_t from = first + c * lane_count;
      const Lanes t = JobLoader(table, fast, group, &jobs[from]).nearest(newton[c]);
      const Mask failed = newton[c].failed | newton[c].active;
      for (std::size_t k = 0; k < lane_count && from + k < count; ++k) {
        const std::size_t ray = jobs[from + k].ray;
        RayGroup& own = group[ray / lane_count];
        if (failed[k]) own.alone.set(ray % lane_count, true);
        if (!(own.near.shift[ray % lane_count] + t[k] > beyond_mm && t[k] < nearest.t[ray])) continue;
        nearest.t[ray] = t[k];
        nearest.s[ray] = newton[c].s[k];
        nearest.r[ray] = newton[c].point.r[k];
        nearest.z[ray] = newton[c].point.z[k];
        nearest.span[ray] = &table.spans[static_cast<std::size_t>(fast.pieces[jobs[from + k].piece].span)];
      }
    }
  }
}

/// make_hit for the rays of one group.
class HitDresser {
 public:
  HitDresser(const SpanTable& table, RayGroup& group, const NearestHits& nearest, std::size_t first_ray)
      : table_(table), group_(group), nearest_(nearest), first_ray_(first_ray) {}

  CATOPTRIC_FORCE_INLINE void run(std::span<std::optional<Hit>> hits) {
    const auto of = [&](const std::vector<double>& from) FORCE_INLINE {
      return gather([&](std::size_t k) FORCE_INLINE { return from[first_ray_ + k]; });
    };
    const Lanes t = of(nearest_.t), s = of(nearest_.s), r = of(nearest_.r), z = of(nearest_.z);
    const Lanes zero = Lanes(0);
    const NearRays<Lanes>& near = group_.near;
    const Lanes x = near.ox + t * near.dx, y = near.oy + t * near.dy;
    const Lanes distance = square_root(x * x + y * y);
    const Lanes ex = x / distance, ey = y / distance;
    Lanes along_r, along_z;
    set_tangent(s, along_r, along_z);
    const Mask met = t < Lanes(HUGE_VAL);
    group_.alone |=
        met & (~((r > zero) & (distance > zero)) | (along_r * along_r + along_z * along_z == zero));
    Lanes nx = along_z * ex, ny = along_z * ey, nz = -along_r;
    const Lanes length = square_root(nx * nx + ny * ny + nz * nz);
    nx = nx / length;
    ny = ny / length;
    nz = nz / length;
    const Mask turn = nx * near.dx + ny * near.dy + nz * near.dz > zero;
    nx = choose(turn, -nx, nx);
    ny = choose(turn, -ny, ny);
    nz = choose(turn, -nz, nz);
    const Lanes along = near.shift + t, px = r * ex, py = r * ey, pz = z + table_.centre_z;
    for (std::size_t k = 0; k < lane_count && k < hits.size(); ++k) {
      hits[k].reset();
      if (!met[k]) continue;
      const SpanForm& span = *nearest_.span[first_ray_ + k];
      hits[k].emplace(Hit{along[k],
                          {px[k], py[k], pz[k]},
                          {nx[k], ny[k], nz[k]},
                          std::min(span.first + s[k] * span.width, span.last)});
    }
  }

 private:
  /// As tangent() in meridian_candidate.cpp; a span of lower degree begins with zeros.
  CATOPTRIC_FORCE_INLINE void set_tangent(const Lanes& s, Lanes& along_r, Lanes& along_z) const {
    const Lanes rest = 1.0 - s;
    const Mask lower = s <= 0.5;
    const Lanes q = choose(lower, s / rest, rest / s);
    const SpanForm* span[lane_count];
    int most = 0;
    for (std::size_t k = 0; k < lane_count; ++k) {
      span[k] = nearest_.span[first_ray_ + k];
      most = std::max(most, span[k]->tangent_degree);
    }
    along_r = along_z = Lanes(0);
    for (int i = most; i >= 0; --i) {
      const auto coefficient = [&](const std::array<double, most_tangent> SpanForm::*of) FORCE_INLINE {
        return gather([&](std::size_t k) FORCE_INLINE {
          const int degree = span[k]->tangent_degree;
          return i <= degree ? (span[k]->*of)[static_cast<std::size_t>(lower[k] ? i : degree - i)] : 0.0;
        });
      };
      along_r = along_r * q + coefficient(&SpanForm::tangent_r);
      along_z = along_z * q + coefficient(&SpanForm::tangent_z);
    }
  }

  const SpanTable& table_;
  RayGroup& group_;
  const NearestHits& nearest_;
  std::size_t first_ray_;
};

CATOPTRIC_VECTOR_CLONES void dress_hits(const SpanTable& table, RayGroup* group, const NearestHits& nearest,
                                        std::span<std::optional<Hit>> hits) {
  for (std::size_t first = 0; first < hits.size(); first += lane_count, ++group)
    HitDresser(table, *group, nearest, first).run(hits.subspan(first));
}

}  // namespace

struct BatchSolver::Work {
  std::vector<RayGroup> group = std::vector<RayGroup>(groups);
  std::vector<CrossingJob> jobs;
  NearestHits nearest;
  std::array<bool, most_rays> alone;
};

BatchSolver::BatchSolver(const SpanTable& table, const FastTable& fast)
    : table_(table), fast_(fast), work_(std::make_unique<Work>()) {
  NearestHits& nearest = work_->nearest;
  for (std::vector<double>* numbers : {&nearest.t, &nearest.s, &nearest.r, &nearest.z})
    numbers->resize(most_rays);
  nearest.span.resize(most_rays);
}

BatchSolver::~BatchSolver() = default;

const std::array<bool, BatchSolver::most_rays>& BatchSolver::solve(std::span<const Ray> rays,
                                                                   double beyond_mm,
                                                                   std::span<std::optional<Hit>> hits) {
  RayGroup* const group = work_->group.data();
  std::vector<CrossingJob>& jobs = work_->jobs;
  NearestHits& nearest = work_->nearest;
  jobs.clear();
  std::fill(nearest.t.begin(), nearest.t.end(), HUGE_VAL);
  std::fill(nearest.span.begin(), nearest.span.end(), table_.spans.data());
  set_groups(table_, rays, beyond_mm, group);
  find_crossings(fast_, static_cast<std::size_t>(table_.degree), group, rays.size(), jobs);
  const std::size_t count = jobs.size();
  if (count > 0) jobs.resize((count + jobs_at_once - 1) / jobs_at_once * jobs_at_once, jobs.back());
  refine_crossings(table_, fast_, group, beyond_mm, jobs, count, nearest);
  dress_hits(table_, group, nearest, hits);
  for (std::size_t i = 0; i < rays.size(); ++i) work_->alone[i] = group[i / lane_count].alone[i % lane_count];
  return work_->alone;
}

}  // namespace catoptric::cad::meridian

bool catoptric::cad::meridian_works_side_by_side() {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  return true;
#elif defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
  static const bool wide = __builtin_cpu_supports("avx2");
  return wide;
#else
  return false;
#endif
}
