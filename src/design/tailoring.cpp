#include "design/tailoring.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/contract.h"
#include "design/direction_residuals.h"
#include "design/search.h"
#include "optim/least_squares.h"

namespace catoptric::design {
namespace {

/// A fraction in (0, 1) that fills the interval evenly as the index grows.
/// @from  Halton 1960
double halton(std::size_t index, std::size_t base) {
  double share = 1, value = 0;
  for (; index > 0; index /= base) {
    share /= static_cast<double>(base);
    value += share * static_cast<double>(index % base);
  }
  return value;
}

/// The start of an attempt: the base's own, or a point of the box; unbounded variables stay.
std::vector<optim::Variable> starting_at(std::vector<optim::Variable> variables, std::size_t attempt) {
  constexpr std::array<std::size_t, 8> primes{2, 3, 5, 7, 11, 13, 17, 19};
  if (attempt == 0) return variables;
  for (std::size_t i = 0; i < variables.size(); ++i) {
    optim::Variable& variable = variables[i];
    if (!(std::isfinite(variable.lower) && std::isfinite(variable.upper))) continue;
    // More variables than primes take later stretches of the same sequences.
    const std::size_t index = attempt + 64 * (i / primes.size());
    variable.start = std::clamp(
        variable.lower + (variable.upper - variable.lower) * halton(index, primes[i % primes.size()]),
        variable.lower, variable.upper);
  }
  return variables;
}

class Tailoring {
 public:
  Tailoring(const FluxMap& map, const AxialLayout& layout, RayMap kind, const ProfileVariables& family,
            const Profile& base, const TailoringOptions& options)
      : map_(map),
        layout_(layout),
        family_(family),
        rays_(map, layout, kind, base.degree(), base.knots(),
              std::max(options.fewest_rays, options.rays_a_point * base.points().size())) {}

  optim::Outcome from(std::vector<optim::Variable> start, const TailoringOptions& options) {
    optim::LeastSquaresProblem problem;
    problem.variables = std::move(start);
    problem.residual_count = rays_.size() + 1;
    problem.evaluate = [this](std::span<const double> x, std::span<double> residuals, double* jacobian) {
      return evaluate(x, residuals, jacobian);
    };
    optim::LevenbergMarquardtOptions search;
    search.most_evaluations = options.most_evaluations;
    search.reach = 1e-3 * options.reach_rad;
    search.value_tolerance = options.value_tolerance;
    return optim::levenberg_marquardt(problem, search);
  }

 private:
  bool evaluate(std::span<const double> x, std::span<double> residuals, double* jacobian) {
    const auto profile = family_.at(x);
    if (!profile) return false;
    const auto& points = profile->points();
    rays_.evaluate(points, residuals.first(rays_.size()), jacobian ? &by_component_ : nullptr);
    // The rim's angle at the source, which decides how much light the mirror takes.
    const double out = points.back().r_mm;
    const double up = layout_.apex_side * (points.back().z_mm - layout_.source_z_mm);
    residuals.back() = std::atan2(out, up) - map_.last_angle_rad();
    if (!jacobian) return true;
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const auto rows = static_cast<Eigen::Index>(rays_.size());
    const auto columns = static_cast<Eigen::Index>(x.size());
    const Eigen::MatrixXd chain = family_.chain(*profile);
    Eigen::Map<Rows> all(jacobian, rows + 1, columns);
    all.topRows(rows).noalias() = by_component_ * chain;
    const double square = out * out + up * up;
    const auto rim = static_cast<Eigen::Index>(3 * (points.size() - 1));
    all.row(rows) = (up / square) * chain.row(rim) - (layout_.apex_side * out / square) * chain.row(rim + 1);
    return true;
  }

  const FluxMap& map_;
  const AxialLayout& layout_;
  const ProfileVariables& family_;
  DirectionResiduals rays_;
  Eigen::MatrixXd by_component_;
};

}  // namespace

Tailored tailor(const FluxMap& map, const AxialLayout& layout, RayMap kind, const ProfileVariables& family,
                const TailoringOptions& options) {
  const std::vector<double> first = starts(family.variables);
  const auto base = family.at(first);
  CATOPTRIC_EXPECTS(base.has_value());
  Tailoring tailoring(map, layout, kind, family, *base, options);
  Tailored best{*base, first, HUGE_VAL, 0, 0};
  for (int attempt = 0; attempt <= options.most_restarts && !(best.miss_rad <= options.reach_rad);
       ++attempt) {
    const optim::Outcome outcome =
        tailoring.from(starting_at(family.variables, static_cast<std::size_t>(attempt)), options);
    best.evaluations += outcome.evaluations;
    ++best.starts;
    if (!(outcome.value < best.miss_rad)) continue;
    best.miss_rad = outcome.value;
    best.values = outcome.best;
  }
  best.profile = family.at(best.values).value_or(*base);
  return best;
}

}  // namespace catoptric::design
