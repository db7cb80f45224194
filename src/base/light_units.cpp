#include "base/light_units.h"

namespace catoptric {

std::string_view flux_unit(LightQuantity quantity) {
  return quantity == LightQuantity::luminous ? "lm" : "W";
}

std::string_view irradiance_unit(LightQuantity quantity) {
  return quantity == LightQuantity::luminous ? "lx" : "W/m^2";
}

std::string_view intensity_unit(LightQuantity quantity) {
  return quantity == LightQuantity::luminous ? "cd" : "W/sr";
}

std::string_view irradiance_name(LightQuantity quantity) {
  return quantity == LightQuantity::luminous ? "illuminance" : "irradiance";
}

std::string printed(std::string_view unit) {
  std::string text(unit);
  if (const auto at = text.find("^2"); at != std::string::npos) text.replace(at, 2, "²");
  return text;
}

}  // namespace catoptric
