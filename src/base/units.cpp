#include "base/units.h"

namespace catoptric {

double millimetres_per(LengthUnit unit) {
  switch (unit) {
    case LengthUnit::millimetre:
      return 1.0;
    case LengthUnit::centimetre:
      return 10.0;
    case LengthUnit::metre:
      return 1000.0;
    case LengthUnit::inch:
      return 25.4;
  }
  return 1.0;
}

std::string_view symbol(LengthUnit unit) {
  switch (unit) {
    case LengthUnit::millimetre:
      return "mm";
    case LengthUnit::centimetre:
      return "cm";
    case LengthUnit::metre:
      return "m";
    case LengthUnit::inch:
      return "in";
  }
  return "mm";
}

std::optional<LengthUnit> parse_length_unit(std::string_view text) {
  for (auto unit : {LengthUnit::millimetre, LengthUnit::centimetre, LengthUnit::metre, LengthUnit::inch})
    if (symbol(unit) == text) return unit;
  return std::nullopt;
}

}  // namespace catoptric
