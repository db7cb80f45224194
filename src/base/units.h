#pragma once

#include <numbers>
#include <optional>
#include <string>
#include <string_view>

namespace catoptric {

inline constexpr double pi = std::numbers::pi;

/// The unit of length a scene speaks. Inside, every length is in millimetres.
enum class LengthUnit { millimetre, centimetre, metre, inch };

/// Millimetres in one of `unit`.
double millimetres_per(LengthUnit unit);

/// "mm", "cm", "m" or "in".
std::string_view symbol(LengthUnit unit);

/// The unit with that symbol, or nothing.
std::optional<LengthUnit> parse_length_unit(std::string_view symbol);

/// Irradiance is W/mm^2 inside and W/m^2 wherever a person reads it.
inline constexpr double w_per_m2_in_w_per_mm2 = 1e-6;
inline constexpr double to_w_per_m2(double w_per_mm2) { return w_per_mm2 / w_per_m2_in_w_per_mm2; }
inline constexpr double from_w_per_m2(double w_per_m2) { return w_per_m2 * w_per_m2_in_w_per_mm2; }

}  // namespace catoptric
