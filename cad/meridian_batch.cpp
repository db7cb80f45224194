#include "cad/meridian_batch.h"

#include <algorithm>

#include "base/float_traps.h"
#include "base/vector_clones.h"
#include "cad/meridian_batch_work.h"
#include "cad/meridian_candidate.h"
#include "cad/meridian_isolate.h"
#include "cad/meridian_reflector.h"

/// For lambdas that become part of code under CATOPTRIC_VECTOR_CLONES.
#define FORCE_INLINE __attribute__((always_inline))

namespace catoptric::cad::meridian {
namespace {

constexpr std::size_t groups = BatchSolver::most_rays / lane_count;

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
    NearRays<Lanes> near;
    near.set(origin(0), origin(1), origin(2), direction(0), direction(1), direction(2), table);
    group->line = AxisLine<Lanes>(near, table);
    const AxisLine<Lanes>& line = group->line;
    group->shift = near.shift;
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

/// work(degree), for the usual degrees in copies of their own, in which the loops vanish. Sanitizers get one
/// copy: with three, it compiles for minutes.
template <typename Work>
FORCE_INLINE inline void for_degree(std::size_t degree, const Work& work) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  work(degree);
#else
  switch (degree) {
    case 2:
      return work(2);
    case 3:
      return work(3);
    default:
      return work(degree);
  }
#endif
}

/// Notes where a ray certainly crosses the generatrix once, and whether that is all there is to it.
struct JobMaker {
  JobList& jobs;
  double slack, wanted;  ///< where along the line hits are certainly wanted
  std::size_t count, ray;
  std::size_t first = jobs.size();  ///< of its jobs
  double end = HUGE_VAL;
  bool alone = false;

  CATOPTRIC_FORCE_INLINE void crosses(const FastPiece& piece, const Crossings& crossings, std::size_t lane) {
    if (crossings.from[lane] > end) return;
    if (crossings.from[lane] >= wanted && crossings.until[lane] + slack < end) {
      end = crossings.until[lane] + slack;
      if (jobs.size() > first) jobs.drop_beyond(end, first);
    }
    jobs.add(crossings, count, lane, piece, ray);
  }
  CATOPTRIC_FORCE_INLINE double until() const { return end; }
  CATOPTRIC_FORCE_INLINE bool doubts(std::size_t) {
    alone = true;
    return false;
  }
};

CATOPTRIC_VECTOR_CLONES void find_crossings(const FastTable& fast, std::size_t degree, RayGroup* group,
                                            std::size_t rays, JobList& jobs) {
  for_degree(degree, [&](std::size_t known) FORCE_INLINE {
    for (std::size_t ray = 0; ray < rays; ++ray) {
      RayGroup& own = group[ray / lane_count];
      const std::size_t lane = ray % lane_count;
      if (!own.open[lane]) continue;
      const auto of_lane = [lane](const auto& of) FORCE_INLINE { return of[lane]; };
      BlockQuery<lane_count> query;
      query.set(own.line, own.culler, own.factors, of_lane, of_lane);
      const double slack = own.culler.slack[lane];
      JobMaker maker{jobs, slack, own.culler.from[lane] + 2 * slack, 2 * known + 1, ray};
      visit_blocks<lane_count>(fast, query, known, maker);
      if (maker.alone) own.alone.set(lane, true);
    }
  });
}

/// Jobs on their way through Newton's method.
class CrossingSolver {
 public:
  CATOPTRIC_FORCE_INLINE CrossingSolver(const SpanTable& table, const FastTable& fast, RayGroup* group,
                                        const CrossingJobs& jobs)
      : table_(table), fast_(fast), group_(group), jobs_(jobs) {}

  CATOPTRIC_FORCE_INLINE void run(std::size_t degree) {
    load_line();
    std::array<LanePair, most_coefficients> f;
    for (std::size_t i = 0; i <= 2 * degree; ++i) f[i] = pair_of(jobs_.f[i]);
    const LanePair lo = gather_pair([&](std::size_t k) FORCE_INLINE { return jobs_.piece[k]->lo; });
    const LanePair hi = gather_pair([&](std::size_t k) FORCE_INLINE { return jobs_.piece[k]->hi; });
    newton_.set_line(line_);
    newton_.begin(f, lo, hi, degree);
    HalfSpan<LanePair> half;
    load_half(half, degree);
    for (int i = 0; i < newton_.most_steps && any(newton_.active); ++i) newton_.step(half, degree);
    newton_.finish(half, degree);
  }

  CATOPTRIC_FORCE_INLINE void keep(std::size_t count, double beyond_mm, NearestHits& nearest) const {
    PairArray t, s, r, z;
    store(along(), t);
    store(newton_.s, s);
    store(newton_.r, r);
    store(newton_.z, z);
    const bool failures = any(newton_.failed);
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t ray = jobs_.ray[k];
      RayGroup& own = group_[ray / lane_count];
      if (failures && newton_.failed[k]) own.alone.set(ray % lane_count, true);
      if (!(own.shift[ray % lane_count] + t[k] > beyond_mm && t[k] < nearest.t[ray])) continue;
      nearest.t[ray] = t[k];
      nearest.s[ray] = s[k];
      nearest.r[ray] = r[k];
      nearest.z[ray] = z[k];
      nearest.span[ray] = &table_.spans[static_cast<std::size_t>(jobs_.piece[k]->span)];
    }
  }

 private:
  /// As distance_along and make_candidate.
  CATOPTRIC_FORCE_INLINE LanePair along() const {
    const DistanceAlong<LanePair> distance{line_, newton_.r, newton_.z};
    const MaskPair by_height = distance.by_height_is_better();
    LanePair t = distance.by_height();
    if (any(~by_height)) t = choose(by_height, t, distance.by_radius());
    return nearest_along(line_, t, newton_.r, newton_.z);
  }

  CATOPTRIC_FORCE_INLINE void load_half(HalfSpan<LanePair>& to, std::size_t degree) const {
    const HalfSpan<double>* half[jobs_at_once];
    for (std::size_t k = 0; k < jobs_at_once; ++k) half[k] = &fast_.halves[jobs_.piece[k]->half];
    for (std::size_t i = 0; i <= degree; ++i) {
      to.rw[i] = gather_pair([&](std::size_t k) FORCE_INLINE { return half[k]->rw[i]; });
      to.zw[i] = gather_pair([&](std::size_t k) FORCE_INLINE { return half[k]->zw[i]; });
      to.w[i] = gather_pair([&](std::size_t k) FORCE_INLINE { return half[k]->w[i]; });
    }
  }

  CATOPTRIC_FORCE_INLINE void load_line() {
    const double* from[jobs_at_once];  // members of AxisLine<Lanes> from a lane on
    for (std::size_t k = 0; k < jobs_at_once; ++k)
      from[k] = reinterpret_cast<const double*>(&group_[jobs_.ray[k] / lane_count].line) +
                jobs_.ray[k] % lane_count;
    const auto take = [&](LanePair AxisLine<LanePair>::*member, std::size_t number) FORCE_INLINE {
      line_.*member = gather_pair([&](std::size_t k) FORCE_INLINE { return from[k][number * lane_count]; });
    };
    take(&AxisLine<LanePair>::ox, 0);
    take(&AxisLine<LanePair>::oy, 1);
    take(&AxisLine<LanePair>::oz, 2);
    take(&AxisLine<LanePair>::dx, 3);
    take(&AxisLine<LanePair>::dy, 4);
    take(&AxisLine<LanePair>::dz, 5);
    take(&AxisLine<LanePair>::h, 6);
    take(&AxisLine<LanePair>::along, 7);
    take(&AxisLine<LanePair>::across, 8);
    take(&AxisLine<LanePair>::level, 9);
    take(&AxisLine<LanePair>::skew, 10);
    take(&AxisLine<LanePair>::scale, 11);
  }

  const SpanTable& table_;
  const FastTable& fast_;
  RayGroup* group_;
  const CrossingJobs& jobs_;
  AxisLine<LanePair> line_;
  CrossingNewton<LanePair> newton_;
};

/// @in    jobs filled up, of which the first `count` matter
CATOPTRIC_VECTOR_CLONES void solve_crossings(const SpanTable& table, const FastTable& fast, RayGroup* group,
                                             double beyond_mm, const CrossingJobs* jobs, std::size_t count,
                                             NearestHits& nearest) {
  for_degree(static_cast<std::size_t>(table.degree), [&](std::size_t degree) FORCE_INLINE {
    for (std::size_t first = 0; first < count; first += jobs_at_once) {
      CrossingSolver solver(table, fast, group, jobs[first / jobs_at_once]);
      solver.run(degree);
      solver.keep(std::min(count - first, jobs_at_once), beyond_mm, nearest);
    }
  });
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
    const AxisLine<Lanes>& near = group_.line;
    const Lanes x = near.ox + t * near.dx, y = near.oy + t * near.dy;
    const Lanes distance = square_root(x * x + y * y), inverse = 1.0 / distance;
    const Lanes ex = x * inverse, ey = y * inverse;
    Lanes along_r, along_z;
    set_tangent(s, along_r, along_z);
    const Mask met = t < Lanes(HUGE_VAL);
    group_.alone |=
        met & (~((r > zero) & (distance > zero)) | (along_r * along_r + along_z * along_z == zero));
    Lanes nx = along_z * ex, ny = along_z * ey, nz = -along_r;
    const Lanes unit = 1.0 / square_root(nx * nx + ny * ny + nz * nz);
    nx = nx * unit;
    ny = ny * unit;
    nz = nz * unit;
    const Mask turn = nx * near.dx + ny * near.dy + nz * near.dz > zero;
    nx = choose(turn, -nx, nx);
    ny = choose(turn, -ny, ny);
    nz = choose(turn, -nz, nz);
    const Lanes along = group_.shift + t, px = r * ex, py = r * ey, pz = z + table_.centre_z;
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
    const bool alike = table_.spans.size() == 1;
    along_r = along_z = Lanes(0);
    for (int i = most; i >= 0; --i) {
      const auto coefficient = [&](const std::array<double, most_tangent> SpanForm::*of) FORCE_INLINE {
        if (alike)
          return choose(lower, Lanes((span[0]->*of)[static_cast<std::size_t>(i)]),
                        Lanes((span[0]->*of)[static_cast<std::size_t>(most - i)]));
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
  JobList jobs;
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
  const UntrappedFloats untrapped;  // lanes compute on where others of their group have a crossing
  RayGroup* const group = work_->group.data();
  JobList& jobs = work_->jobs;
  NearestHits& nearest = work_->nearest;
  jobs.clear();
  std::fill(nearest.t.begin(), nearest.t.end(), HUGE_VAL);
  std::fill(nearest.span.begin(), nearest.span.end(), table_.spans.data());
  set_groups(table_, rays, beyond_mm, group);
  find_crossings(fast_, static_cast<std::size_t>(table_.degree), group, rays.size(), jobs);
  jobs.fill_up();
  solve_crossings(table_, fast_, group, beyond_mm, jobs.data(), jobs.size(), nearest);
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
