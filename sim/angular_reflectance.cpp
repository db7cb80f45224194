#include "sim/angular_reflectance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "base/float_traps.h"
#include "base/units.h"
#include "sim/fresnel.h"

namespace catoptric::sim {
namespace {

[[noreturn]] void refuse_course(std::string what, std::string why, std::string hint) {
  throw InputError({std::move(what), "reflectance by angle", std::move(why), std::move(hint)});
}

}  // namespace

std::shared_ptr<const AngularReflectance> AngularReflectance::table(std::vector<double> angles_rad,
                                                                    std::vector<double> reflectances) {
  const UntrappedFloats untrapped;  // NaN is one of the things refused
  if (angles_rad.empty() || angles_rad.size() != reflectances.size())
    refuse_course(fmt::format("{} angles for {} reflectances", angles_rad.size(), reflectances.size()),
                  "each angle has one", "give as many of both");
  constexpr double slack_rad = 1e-12;  // 90 degrees in radians may be a rounding more than pi / 2
  for (std::size_t i = 0; i < angles_rad.size(); ++i) {
    if (!(angles_rad[i] >= 0 && angles_rad[i] <= 0.5 * pi + slack_rad))
      refuse_course(fmt::format("an incidence of {:.4g} degrees", angles_rad[i] * 180 / pi),
                    "it is measured from the normal, 0 to 90 degrees", "");
    if (i > 0 && !(angles_rad[i] > angles_rad[i - 1]))
      refuse_course("angles do not rise", "the reflectance is linear from each to the next", "sort them");
    if (!(reflectances[i] >= 0 && reflectances[i] <= 1))
      refuse_course(fmt::format("reflectance {} is out of range", reflectances[i]),
                    "a reflectance lies between 0 and 1", "");
  }
  const double greatest = *std::max_element(reflectances.begin(), reflectances.end());
  if (!(greatest > 0))
    refuse_course("nothing is reflected at any angle", "there is no course to follow", "reflectance = 0");
  for (double& value : reflectances) value /= greatest;
  return std::shared_ptr<const AngularReflectance>(
      new AngularReflectance(Table{std::move(angles_rad), std::move(reflectances)}));
}

std::shared_ptr<const AngularReflectance> AngularReflectance::metal(double index, double extinction) {
  const UntrappedFloats untrapped;  // NaN is one of the things refused
  if (!(index > 0 && std::isfinite(index) && extinction >= 0 && std::isfinite(extinction)))
    refuse_course(fmt::format("index {} with extinction {}", index, extinction),
                  "a metal's index is positive and its extinction not negative, both finite",
                  "aluminium in green light: index 1.1, extinction 6.6");
  return std::shared_ptr<const AngularReflectance>(new AngularReflectance(Metal{index, extinction}));
}

double AngularReflectance::relative(double cosine) const {
  cosine = std::clamp(cosine, 0.0, 1.0);
  if (const auto* metal = std::get_if<Metal>(&law_))
    return conductor_reflectance(cosine, metal->index, metal->extinction);
  const auto& [angles, values] = std::get<Table>(law_);
  const double angle = std::acos(cosine);
  const auto next =
      static_cast<std::size_t>(std::upper_bound(angles.begin(), angles.end(), angle) - angles.begin());
  if (next == 0) return values.front();
  if (next == angles.size()) return values.back();
  const double share = (angle - angles[next - 1]) / (angles[next] - angles[next - 1]);
  return values[next - 1] + share * (values[next] - values[next - 1]);
}

}  // namespace catoptric::sim
