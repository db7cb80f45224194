#include "sim/material.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace catoptric::sim {

Material Material::with_table(std::vector<double> angles_rad, std::vector<double> reflectances) {
  Material material;
  material.by_angle = AngularReflectance::table(std::move(angles_rad), reflectances);
  material.reflectance = *std::max_element(reflectances.begin(), reflectances.end());
  return material;
}

Material Material::metal(double index, double extinction) {
  Material material;
  material.by_angle = AngularReflectance::metal(index, extinction);
  return material;
}

bool Material::operator==(const Material& other) const {
  const bool same_course =
      by_angle == other.by_angle || (by_angle && other.by_angle && *by_angle == *other.by_angle);
  return reflectance == other.reflectance && transmittance == other.transmittance &&
         diffuse == other.diffuse && roughness == other.roughness && same_course;
}

std::optional<ErrorParts> find_defect(const Material& material) {
  const auto is_share = [](double value) { return value >= 0 && value <= 1; };  // false for NaN
  if (!is_share(material.reflectance))
    return ErrorParts{fmt::format("reflectance {} is out of range", material.reflectance), "",
                      "a reflectance lies between 0 and 1", "0.9 is ordinary polished aluminium"};
  if (!is_share(material.transmittance))
    return ErrorParts{fmt::format("transmittance {} is out of range", material.transmittance), "",
                      "a transmittance lies between 0 and 1", "0 makes the surface opaque"};
  if (!is_share(material.diffuse))
    return ErrorParts{fmt::format("diffuse reflectance {} is out of range", material.diffuse), "",
                      "a reflectance lies between 0 and 1", "0.8 is ordinary white paint"};
  if (material.roughness != 0 && !(material.roughness >= least_roughness && material.roughness <= 1))
    return ErrorParts{fmt::format("roughness {} is out of range", material.roughness), "",
                      fmt::format("a roughness is 0, or lies between {} and 1", least_roughness),
                      "0 makes the mirror smooth; brushed metal has 0.1 to 0.3"};
  constexpr double slack = 1e-12;  // decimal shares such as 0.7 + 0.3 round to a few 1e-16 above 1
  if (material.reflectance + material.diffuse + material.transmittance > 1 + slack) {
    std::string shares =
        fmt::format("reflectance {}{}", material.reflectance, material.by_angle ? " (its greatest)" : "");
    if (material.diffuse > 0) shares += fmt::format(", diffuse reflectance {}", material.diffuse);
    return ErrorParts{
        fmt::format("{} and transmittance {} add up to more than 1", shares, material.transmittance), "",
        "a surface cannot send on more light than it gets", "lower one of them"};
  }
  return std::nullopt;
}

}  // namespace catoptric::sim
