#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace catoptric::rayfiles {

/// The unit of positions in a Zemax ray file.
enum class ZemaxUnit : std::uint32_t { metre = 0, inch = 1, centimetre = 2, foot = 3, millimetre = 4 };

double millimetres_per(ZemaxUnit unit);

/// "m", "in", "cm", "ft" or "mm".
std::string_view symbol(ZemaxUnit unit);

/// What a ray consists of beside position, direction and flux.
enum class ZemaxRays : std::int32_t { flux_only = 0, spectral_color = 2 };

enum class ZemaxFlux : std::int32_t { watts = 0, lumens = 1 };

/// The header of a Zemax binary source file (.dat, .sdf), field by field. OpticStudio itself looks at the
/// number of rays, the unit, the ray format and the flux type only.
/// @from  OpticStudio help, Source File, binary format; TM25RaySetTools (J. Muschaweck, Unlicense)
struct ZemaxHeader {
  std::uint32_t ray_count = 0;  ///< at most 4,000,000,000; writers fill it in
  std::string description;      ///< up to 100 bytes
  float source_flux = 0;        ///< of the source, W or lm
  float ray_set_flux = 0;       ///< of these rays, W or lm
  float wavelength_um = 0;      ///< 0 for a mixture
  std::array<float, 2> inclination_deg{};
  std::array<float, 2> azimuth_deg{};
  ZemaxUnit unit = ZemaxUnit::millimetre;
  std::array<float, 3> location{};      ///< in `unit`; not applied to the rays
  std::array<float, 3> rotation_rad{};  ///< not applied to the rays
  std::array<float, 3> scale{1, 1, 1};  ///< unused
  std::array<float, 4> unused{};
  ZemaxRays rays = ZemaxRays::flux_only;
  ZemaxFlux flux = ZemaxFlux::watts;  ///< of spectral_color always watts
  std::array<std::int32_t, 2> reserved{};
};

inline constexpr std::uint64_t zemax_header_size = 208;
inline constexpr std::uint64_t most_zemax_rays = 4'000'000'000;

/// The names of a ray's numbers: "x", "y", "z", "l", "m", "n", "flux" and for spectral_color "wavelength"
/// (um). Each is a 32-bit float.
std::vector<std::string> columns(const ZemaxHeader& header);

/// A header as read, and what is odd about it.
struct ZemaxReading {
  ZemaxHeader header;
  std::vector<std::string> notes;
};

/// Whether the bytes begin as a Zemax file of either byte order does.
bool looks_like_zemax(std::span<const std::byte> bytes);

/// @in    bytes of the whole file; name for messages
/// @fails InputError with file, byte, field and rule: another byte order, an end within the header,
///        no rays or too many, an unknown unit, ray format or flux type, or lumens in the spectral format
ZemaxReading read_zemax_header(std::span<const std::byte> bytes, const std::string& name);

/// The header's 208 bytes. A description that is too long is cut.
std::string zemax_header_bytes(const ZemaxHeader& header);

}  // namespace catoptric::rayfiles
