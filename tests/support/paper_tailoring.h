#pragma once

#include <cmath>

#include "base/units.h"
#include "design/tailoring.h"

/// The paper's scene as tailoring sees it: a source 50 mm above the near field, the paraboloid's light
/// wanted.
namespace catoptric::test {

inline constexpr double paper_focus_mm = 50, paper_power_w = pi / 100;
inline const design::AxialLayout paper_layout{paper_focus_mm, 0, 1};

inline design::FluxMap paper_map() {
  constexpr double a = paper_focus_mm;
  return design::FluxMap(design::polar_flux(paper_power_w, 0, true), 1,
                         {[](double p) {
                            const double widening = 1 + p * p / (4 * a * a);
                            return paper_power_w / (4 * pi * a * a * widening * widening);
                          },
                          {},
                          2 * a});
}

/// The paper's two variables in its box, the weight by its logarithm.
inline design::ProfileVariables paper_variables(double w1, double r2_mm) {
  constexpr double a = paper_focus_mm;
  design::ProfileVariables family;
  family.variables = {{"w1", std::log(w1), 0.1, std::log(0.05), std::log(20.0)}, {"r2", r2_mm, 1, 10, 300}};
  family.at = [](std::span<const double> x) -> std::optional<Profile> {
    return Profile::bezier({{0, 2 * a, 1}, {a, 2 * a, std::exp(x[0])}, {x[1], a, 1}});
  };
  family.chain = [](const Profile& profile) {
    Eigen::MatrixXd chain = Eigen::MatrixXd::Zero(9, 2);
    chain(5, 0) = profile.points()[1].weight;
    chain(6, 1) = 1;
    return chain;
  };
  return family;
}

}  // namespace catoptric::test
