#include <algorithm>
#include <cmath>
#include <memory>

#include "base/ordered_sum.h"
#include "design/constraints.h"
#include "design/design_space.h"
#include "design/evaluator.h"
#include "design/metrics.h"
#include "design/search.h"
#include "design/search_methods.h"
#include "design/stage.h"
#include "sim/rings.h"
#include "sim/simulation.h"
#include "sim/tubes_jacobian.h"

namespace catoptric::design {
namespace {

/// Everything about the fit that no design vector changes.
struct Fit {
  const Scene& scene;
  const Target& target;
  ShapeFamily family;
  std::vector<double> radii_mm;        ///< each once, rising
  std::vector<std::size_t> radius_of;  ///< of each sample
  Eigen::MatrixXd listed;     ///< of listed variables: components (rows) by variables, as FreeProfile::chain
  std::vector<double> scale;  ///< W/mm^2 to the residuals' unit, over the root of their number or weights
  sim::TubesOptions tubes;

  bool evaluate(std::span<const double> x, std::span<double> residuals, double* jacobian) const;

 private:
  Eigen::MatrixXd chain(const Profile& profile) const {
    const auto* free = std::get_if<FreeProfile>(&family);
    return free ? free->chain(profile) : listed;
  }
  bool fill(const sim::TubesField& field, const std::vector<double>& direct,
            std::span<double> residuals) const;
};

bool Fit::fill(const sim::TubesField& field, const std::vector<double>& direct,
               std::span<double> residuals) const {
  if (!believed(field, tubes)) return false;
  for (std::size_t i = 0; i < residuals.size(); ++i)
    residuals[i] = scale[i] * (direct[i] + field.irradiance[radius_of[i]] - target.irradiance_w_per_mm2[i]);
  return true;
}

bool Fit::evaluate(std::span<const double> x, std::span<double> residuals, double* jacobian) const {
  const auto profile = std::visit([&](const auto& each) { return each.at(x); }, family);
  if (!profile || violation(scene.constraints, *profile) > 0) return false;  // a step too far
  const Stage stage(scene, *profile);
  const std::vector<double> direct = sim::direct_field(stage.scene, target.samples);
  const auto& source = dynamic_cast<const sim::PointSource&>(*stage.source);  // which ray tubes have proven
  const sim::FieldPlane plane{scene.near_field.center_mm().z(), scene.near_field.normal().z() > 0};
  if (!jacobian)
    return fill(sim::tubes_field(source, *profile, scene.mirror, plane, radii_mm, tubes), direct, residuals);
  const sim::TubesJacobian by_all =
      sim::tubes_jacobian(source, *profile, scene.mirror, plane, radii_mm, tubes);
  const Eigen::MatrixXd by = by_all.by_variable * chain(*profile);
  for (std::size_t i = 0; i < residuals.size(); ++i)
    for (Eigen::Index j = 0; j < by.cols(); ++j)
      *jacobian++ = scale[i] * by(static_cast<Eigen::Index>(radius_of[i]), j);
  return fill(by_all.field, direct, residuals);
}

/// Each listed variable is a component, in its unit.
Eigen::MatrixXd listed_chain(const Scene& scene) {
  const std::size_t points = scene.profile.points().size();
  Eigen::MatrixXd chain = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(3 * points),
                                                static_cast<Eigen::Index>(scene.variables.size()));
  for (std::size_t j = 0; j < scene.variables.size(); ++j) {
    const Component component = *parse_component(scene.variables[j].name, points);
    const std::size_t row = 3 * component.point + std::string_view("rzw").find(component.coordinate);
    chain(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(j)) =
        component.coordinate == 'w' ? 1.0 : millimetres_per(scene.unit);
  }
  return chain;
}

}  // namespace

void require_fit(const Scene& scene, sim::Rung rung) {
  const auto refuse = [&](std::string why) {
    throw scene.settings.error("search.method", "Levenberg-Marquardt cannot search here", std::move(why),
                               "search.method = \"cma-es\"");
  };
  if (rung != sim::Rung::tubes)
    refuse("its derivatives come from ray tubes, and this scene's light is computed by " +
           std::string(sim::name(rung)));
  for (const optim::Variable& variable : scene.variables)
    if (parse_scene_variable(variable.name))
      refuse("its derivatives are by the mirror's shape, not by " + variable.name);
  if (scene.search.free == Freedom::curvature)
    refuse("its derivatives are by control points, not by curvatures");
  if (is_of_intensity(scene.search.metric) || more_is_better(scene.search.metric) || scene.target.free_scale)
    refuse("it makes rmse or relative-rmse small, against a target of absolute scale");
  if (scene.mirror.transmittance > 0) refuse("its derivatives are for mirrors that let no light through");
  if (scene.mirror.by_angle) refuse("its derivatives are for mirrors that reflect alike at all angles");
}

optim::LeastSquaresProblem fit_problem(const Scene& scene, const Target& target) {
  const std::vector<double> radii_mm = sim::ring_radii_mm(scene.near_field, target.samples);
  auto fit = std::make_shared<Fit>(Fit{scene,
                                       target,
                                       shape_family(scene),
                                       radii_mm,
                                       {},
                                       {},
                                       {},
                                       tubes_options(scene, *scene.model.estimate.kernel_radius_mm)});
  // As the objective's tubes are: good for what is wanted here, however little of the source's power it is.
  constexpr double tolerance_of_target = 1e-6;
  fit->tubes.tolerance_w_per_mm2 =
      std::min(fit->tubes.tolerance_w_per_mm2,
               tolerance_of_target * root_mean_square(target.irradiance_w_per_mm2, target.weights));
  std::ranges::sort(fit->radii_mm);
  fit->radii_mm.erase(std::ranges::unique(fit->radii_mm).begin(), fit->radii_mm.end());
  for (const double radius : radii_mm)
    fit->radius_of.push_back(
        static_cast<std::size_t>(std::ranges::lower_bound(fit->radii_mm, radius) - fit->radii_mm.begin()));
  if (scene.search.free == Freedom::listed) fit->listed = listed_chain(scene);
  const double unit = scene.search.metric == Metric::rmse
                          ? to_w_per_m2(1.0)
                          : 1 / root_mean_square(target.irradiance_w_per_mm2, target.weights);
  if (target.weights.empty())
    fit->scale.assign(radii_mm.size(), unit / std::sqrt(static_cast<double>(radii_mm.size())));
  for (const double weight : target.weights)
    fit->scale.push_back(unit * std::sqrt(weight / ordered_sum(target.weights)));
  return {scene.variables, radii_mm.size(),
          [fit](std::span<const double> x, std::span<double> residuals, double* jacobian) {
            return fit->evaluate(x, residuals, jacobian);
          }};
}

}  // namespace catoptric::design
