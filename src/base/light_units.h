#pragma once

#include <string>
#include <string_view>

namespace catoptric {

/// What is measured: power (W, W/m^2, W/sr) or light as eyes see it (lm, lx, cd). One is never taken for the
/// other, and none is turned into the other: that would take a spectrum.
enum class LightQuantity { radiant, luminous };

/// "W" or "lm".
std::string_view flux_unit(LightQuantity quantity);
/// "W/m^2" or "lx".
std::string_view irradiance_unit(LightQuantity quantity);
/// "W/sr" or "cd".
std::string_view intensity_unit(LightQuantity quantity);

/// "irradiance" or "illuminance".
std::string_view irradiance_name(LightQuantity quantity);

/// A unit as print has it: "W/m²".
std::string printed(std::string_view unit);

}  // namespace catoptric
