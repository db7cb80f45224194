#include "rayfiles/zemax_header.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/contract.h"
#include "base/float_traps.h"
#include "rayfiles/detail/byte_reader.h"

namespace catoptric::rayfiles {
namespace {

using detail::append;
using detail::ByteReader;

constexpr std::uint32_t identifier = 1010;
constexpr std::size_t description_size = 100;

template <std::size_t n>
void read(ByteReader& in, std::array<float, n>& numbers, std::string_view field) {
  for (float& number : numbers) number = in.read<float>(field);
}

template <typename Number, std::size_t n>
void append_all(std::string& bytes, const std::array<Number, n>& numbers) {
  for (const Number number : numbers) append(bytes, number);
}

void read_identifier(ByteReader& in) {
  const auto value = in.read<std::uint32_t>("Identifier");
  if (detail::byte_reversed(value) == identifier)
    in.refuse("the file is big-endian", "Zemax files are little-endian",
              "write it anew with another program");
  if (value != identifier)
    in.refuse(fmt::format("identifier {} is not known", value), "Zemax ray files have 1010",
              "export the file anew");
}

void read_count(ByteReader& in, ZemaxHeader& header) {
  header.ray_count = in.read<std::uint32_t>("NbrRays");
  if (header.ray_count == 0) in.refuse("there are no rays", "a source has at least one");
  if (header.ray_count > most_zemax_rays)
    in.refuse(fmt::format("{} rays are too many", header.ray_count), "Zemax files hold 4,000,000,000 at most",
              "copy the file again");
}

void read_unit(ByteReader& in, ZemaxHeader& header) {
  const auto unit = in.read<std::uint32_t>("DimensionUnits");
  if (unit > 4)
    in.refuse(fmt::format("unit {} is not known", unit),
              "0 is metre, 1 inch, 2 centimetre, 3 foot, 4 millimetre");
  header.unit = static_cast<ZemaxUnit>(unit);
}

void read_formats(ByteReader& in, ZemaxHeader& header) {
  const auto rays = in.read<std::int32_t>("ray_format_type");
  if (rays != 0 && rays != 2)
    in.refuse(fmt::format("ray format {} is not known", rays), "0 is flux only, 2 spectral color");
  header.rays = static_cast<ZemaxRays>(rays);
  const auto flux = in.read<std::int32_t>("flux_type");
  if (flux != 0 && flux != 1)
    in.refuse(fmt::format("flux type {} is not known", flux), "0 is watts, 1 lumens");
  header.flux = static_cast<ZemaxFlux>(flux);
  if (header.rays == ZemaxRays::spectral_color && header.flux == ZemaxFlux::lumens)
    in.refuse("lumens in the spectral format", "rays with wavelengths carry watts");
}

template <std::size_t n>
bool any(const std::array<float, n>& numbers) {
  return std::any_of(numbers.begin(), numbers.end(), [](float number) { return number != 0; });
}

}  // namespace

double millimetres_per(ZemaxUnit unit) {
  switch (unit) {
    case ZemaxUnit::metre:
      return 1000;
    case ZemaxUnit::inch:
      return 25.4;
    case ZemaxUnit::centimetre:
      return 10;
    case ZemaxUnit::foot:
      return 304.8;
    case ZemaxUnit::millimetre:
      break;
  }
  return 1;
}

std::string_view symbol(ZemaxUnit unit) {
  constexpr std::string_view symbols[] = {"m", "in", "cm", "ft", "mm"};
  return symbols[static_cast<std::size_t>(unit)];
}

std::vector<std::string> columns(const ZemaxHeader& header) {
  std::vector<std::string> names{"x", "y", "z", "l", "m", "n", "flux"};
  if (header.rays == ZemaxRays::spectral_color) names.emplace_back("wavelength");
  return names;
}

bool looks_like_zemax(std::span<const std::byte> bytes) {
  if (bytes.size() < sizeof identifier) return false;
  const auto begin = detail::load<std::uint32_t>(bytes.data());
  return begin == identifier || detail::byte_reversed(begin) == identifier;
}

ZemaxReading read_zemax_header(std::span<const std::byte> bytes, const std::string& name) {
  const UntrappedFloats unused_fields_may_be_nan;
  ByteReader in(bytes, name);
  ZemaxReading reading;
  ZemaxHeader& header = reading.header;
  read_identifier(in);
  read_count(in, header);
  header.description = detail::until_nul(in.text(description_size, "Description"));
  header.source_flux = in.read<float>("SourceFlux");
  header.ray_set_flux = in.read<float>("RaySetFlux");
  header.wavelength_um = in.read<float>("Wavelength");
  read(in, header.inclination_deg, "InclinationBeg, InclinationEnd");
  read(in, header.azimuth_deg, "AzimuthBeg, AzimuthEnd");
  read_unit(in, header);
  read(in, header.location, "LocX, LocY, LocZ");
  read(in, header.rotation_rad, "RotX, RotY, RotZ");
  read(in, header.scale, "ScaleX, ScaleY, ScaleZ");
  read(in, header.unused, "unused");
  read_formats(in, header);
  for (std::int32_t& number : header.reserved) number = in.read<std::int32_t>("reserved");
  if (any(header.location) || any(header.rotation_rad))
    reading.notes.emplace_back("the header's translation and rotation are not applied, nor does OpticStudio");
  CATOPTRIC_ENSURES(in.next_byte() == zemax_header_size);
  return reading;
}

std::string zemax_header_bytes(const ZemaxHeader& header) {
  std::string bytes;
  append(bytes, identifier);
  append(bytes, header.ray_count);
  std::string description = header.description;
  description.resize(description_size, '\0');
  bytes += description;
  for (const float number : {header.source_flux, header.ray_set_flux, header.wavelength_um})
    append(bytes, number);
  append_all(bytes, header.inclination_deg);
  append_all(bytes, header.azimuth_deg);
  append(bytes, static_cast<std::uint32_t>(header.unit));
  append_all(bytes, header.location);
  append_all(bytes, header.rotation_rad);
  append_all(bytes, header.scale);
  append_all(bytes, header.unused);
  append(bytes, static_cast<std::int32_t>(header.rays));
  append(bytes, static_cast<std::int32_t>(header.flux));
  append_all(bytes, header.reserved);
  CATOPTRIC_ENSURES(bytes.size() == zemax_header_size);
  return bytes;
}

}  // namespace catoptric::rayfiles
