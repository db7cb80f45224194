#include "sim/material.h"

#include <fmt/format.h>

namespace catoptric::sim {

std::optional<ErrorParts> find_defect(const Material& material) {
  const auto is_share = [](double value) { return value >= 0 && value <= 1; };  // false for NaN
  if (!is_share(material.reflectance))
    return ErrorParts{fmt::format("reflectance {} is out of range", material.reflectance), "",
                      "a reflectance lies between 0 and 1", "0.9 is ordinary polished aluminium"};
  if (!is_share(material.transmittance))
    return ErrorParts{fmt::format("transmittance {} is out of range", material.transmittance), "",
                      "a transmittance lies between 0 and 1", "0 makes the surface opaque"};
  constexpr double slack = 1e-12;  // decimal shares such as 0.7 + 0.3 round to a few 1e-16 above 1
  if (material.reflectance + material.transmittance > 1 + slack)
    return ErrorParts{fmt::format("reflectance {} and transmittance {} add up to more than 1",
                                  material.reflectance, material.transmittance),
                      "", "a surface cannot send on more light than it gets", "lower one of them"};
  return std::nullopt;
}

}  // namespace catoptric::sim
