#include "sim/tubes_jacobian.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "base/units.h"
#include "sim/ray_derivative.h"
#include "sim/tube_kernel.h"
#include "sim/tube_map.h"
#include "sim/tube_rings.h"
#include "sim/tube_setup.h"

namespace catoptric::sim {
namespace {

/// A tube that is off by this share of the kernel radius was left so because it holds no light to speak of;
/// what its quintic would do when the mirror moves means nothing.
constexpr double crude = 1e-2;

/// Where a branch ends: its last ray, towards which side no more of it comes, and the power per radian there.
struct BranchEnd {
  double theta_rad;
  double outwards;  ///< -1 where the branch begins, 1 where it ends
  double rho_mm;
  double watts_per_rad;
};

/// Which of the tubes' ends are ends of their branch.
std::vector<BranchEnd> branch_ends(const std::vector<Tube>& tubes, const AxialLight& light) {
  constexpr double gap_rad = 1e-12;  // knots leave a gap of some roundings
  const auto joined = [&](const Tube& before, const Tube& after) {
    return before.path == after.path && std::abs(after.first_rad - before.last_rad) < gap_rad;
  };
  std::vector<bool> continued(tubes.size());
  std::vector<BranchEnd> ends;
  const auto add = [&](const Tube& tube, double theta, double outwards, double rho) {
    // Along the axis there is no light to lose, nor at the angle where the source's own light ends.
    if (std::sin(theta) < 1e-9 || (!light.law.is_even() && std::abs(std::cos(theta)) < 1e-9)) return;
    ends.push_back({theta, outwards, rho,
                    0.5 * light.power_w * light.relative_at(theta) * tube.weight * std::sin(theta)});
  };
  for (std::size_t i = 0; i < tubes.size(); ++i) {
    bool begins = true;
    for (std::size_t j = i; begins && j-- > 0 && tubes[j].last_rad > tubes[i].first_rad - gap_rad;)
      if (joined(tubes[j], tubes[i])) {
        begins = false;
        continued[j] = true;
      }
    if (begins) add(tubes[i], tubes[i].first_rad, -1, tubes[i].begin_mm);
  }
  for (std::size_t i = 0; i < tubes.size(); ++i)
    if (!continued[i]) add(tubes[i], tubes[i].last_rad, 1, tubes[i].end_mm);
  return ends;
}

/// How an edge moves, by the rays on both of its sides: the first meeting that only one of them has, or that
/// they have with different parts of the mirror, passes the edge. Zero where the branch goes on past a sliver
/// of other paths; nothing where only the landing ends.
std::optional<Jet::Row> edge_motion(const RayDerivative& tracer, const BranchEnd& end) {
  const RayJets inside = tracer.trace(end.theta_rad);
  bool goes_on = false;
  for (double gap = 4e-14; gap < 1e-2; gap *= 4) {
    const RayJets outside = tracer.trace(end.theta_rad + end.outwards * gap);
    std::size_t k = 0;
    const std::size_t both = std::min(inside.hits.size(), outside.hits.size());
    const auto same = [&](const PlanarHit& a, const PlanarHit& b) {
      return a.span == b.span && a.side == b.side &&
             std::abs(a.distance_mm - b.distance_mm) < 1e-2 * a.distance_mm;
    };
    while (k < both && same(inside.hits[k], outside.hits[k])) ++k;
    if (k == inside.hits.size() && k == outside.hits.size()) {
      goes_on = tracer.landings(outside).size() == tracer.landings(inside).size();
      continue;
    }
    // The nearer of the two is there only for its own ray; the other one passes it.
    const bool by_outside =
        k == inside.hits.size() ||
        (k < outside.hits.size() && outside.hits[k].distance_mm < inside.hits[k].distance_mm);
    return by_outside ? tracer.edge_moves(outside.lines[k], outside.hits[k])
                      : tracer.edge_moves(inside.lines[k], inside.hits[k]);
  }
  if (goes_on) return Jet::Row{};
  return std::nullopt;
}

/// The sensitivities of the tubes' quintics for one group of variables.
class TubeMotions {
 public:
  using Rows = std::array<Jet::Row, 6>;  ///< of rho[0] to rho[5]

  TubeMotions(const TubeTracer& paths, const RayDerivative& tracer) : paths_(paths), tracer_(tracer) {}

  Rows of(const Tube& tube) {
    const Jet &a = ray(tube, tube.first_rad), &m = ray(tube, tube.theta_rad(0)),
              &b = ray(tube, tube.last_rad);
    const double half = tube.half_width_rad();
    Rows rows;
    for (std::size_t i = 0; i < variables_at_once; ++i) {
      double c[6];
      Hermite{a.x[i], m.x[i], b.x[i], half * a.tx[i], half * m.tx[i], half * b.tx[i]}.quintic(c);
      for (std::size_t k = 0; k < 6; ++k) rows[k][i] = c[k];
    }
    return rows;
  }

 private:
  /// The landing of the tube's path; the angle of a middle ray may be a rounding off the one that was traced.
  const Jet& ray(const Tube& tube, double theta_rad) {
    const auto key = std::pair(theta_rad, tube.path);
    const auto known = known_.find(key);
    if (known != known_.end()) return known->second;
    landings_.clear();
    paths_.trace(theta_rad, landings_);
    const std::vector<Jet> jets = tracer_.landings(tracer_.trace(theta_rad));
    for (std::size_t i = 0; i < std::min(jets.size(), landings_.size()); ++i)
      known_.emplace(std::pair(theta_rad, landings_[i].path), jets[i]);
    return known_[key];
  }

  const TubeTracer& paths_;
  const RayDerivative& tracer_;
  std::vector<Landing> landings_;
  std::map<std::pair<double, std::uint64_t>, Jet> known_;
};

}  // namespace

TubesJacobian tubes_jacobian(const PointSource& source, const Profile& profile, const Material& mirror,
                             const FieldPlane& plane, std::span<const double> radii_mm,
                             const TubesOptions& options) {
  if (!(options.kernel_radius_mm > 0) || mirror.transmittance > 0 || mirror.by_angle)
    throw InputError({"no derivatives of this field", "tubes",
                      "they are those of smoothed light from a mirror that does not transmit and reflects "
                      "alike at all angles",
                      "give a kernel radius; leave the transmittance out, and take one reflectance"});
  TubesJacobian result;
  result.field = tubes_field(source, profile, mirror, plane, radii_mm, options);
  const auto points = profile.points().size();
  result.by_variable.setZero(static_cast<Eigen::Index>(radii_mm.size()),
                             static_cast<Eigen::Index>(3 * points));
  if (radii_mm.empty() || source.power_w() <= 0) return result;

  const FieldRadii radii(radii_mm);
  const AxialLight light = AxialLight::of(source);
  const double h = options.kernel_radius_mm, z = source.position_mm().z();
  const TubeTracer paths = tracer_for(source, profile, mirror, plane, options);
  const TubeMap map = map_for(paths, source, profile, radii, options);
  const TubeRings rings(map.tubes, light, h, radii.distinct_mm, options.tolerance_w_per_mm2);
  const std::vector<BranchEnd> ends = branch_ends(map.tubes, light);

  std::vector<std::vector<TubeMotions::Rows>> motions;
  std::vector<std::vector<Jet::Row>> edges;
  for (std::size_t group = 0; 4 * group < points; ++group) {
    const RayDerivative tracer(profile, z, plane, options.most_interactions, group);
    TubeMotions tubes(paths, tracer);
    motions.emplace_back();
    for (const Tube& tube : map.tubes) motions.back().push_back(tubes.of(tube));
    edges.emplace_back();
    for (const BranchEnd& end : ends) {
      const auto motion = edge_motion(tracer, end);
      if (!motion && group == 0)
        result.unmoved_w_per_mm2 =
            std::max(result.unmoved_w_per_mm2, end.watts_per_rad * kernel_peak_per_mm2(h));
      edges.back().push_back(motion.value_or(Jet::Row{}));
    }
  }

  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(radii.distinct_mm.size()),
                                               static_cast<Eigen::Index>(3 * points));
  std::vector<std::array<double, 6>> moments(map.tubes.size());
  for (std::size_t r = 0; r < radii.distinct_mm.size(); ++r) {
    const double at = radii.distinct_mm[r];
    rings.moments(at, moments);
    for (std::size_t group = 0; group < motions.size(); ++group) {
      Jet::Row sum{};
      for (std::size_t t = 0; t < moments.size(); ++t) {
        if (!(map.tubes[t].off_mm < crude * h)) continue;
        for (std::size_t k = 0; k < 6; ++k)
          for (std::size_t i = 0; i < variables_at_once; ++i)
            sum[i] += moments[t][k] * motions[group][t][k][i];
      }
      for (std::size_t e = 0; e < ends.size(); ++e) {
        const double kernel = kernel_ring_mean(at / h, std::abs(ends[e].rho_mm) / h).value;
        if (kernel == 0) continue;
        const double brightness = ends[e].outwards * ends[e].watts_per_rad * kernel_peak_per_mm2(h) * kernel;
        for (std::size_t i = 0; i < variables_at_once; ++i) sum[i] += brightness * edges[group][e][i];
      }
      const std::size_t count = std::min(variables_at_once, 3 * points - variables_at_once * group);
      for (std::size_t i = 0; i < count; ++i)
        rows(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(variables_at_once * group + i)) = sum[i];
    }
  }
  for (std::size_t i = 0; i < radii.places.size(); ++i)
    result.by_variable.row(static_cast<Eigen::Index>(i)) =
        rows.row(static_cast<Eigen::Index>(radii.places[i]));
  return result;
}

}  // namespace catoptric::sim
