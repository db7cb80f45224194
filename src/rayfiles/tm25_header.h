#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace catoptric::rayfiles {

/// Where the wavelengths of a TM-25 file stand.
enum class Tm25Spectrum : std::int32_t {
  none = 0,
  single_wavelength = 1,  ///< one for all rays, in the header
  wavelength_of_ray = 2,  ///< a column
  one_table = 3,
  table_of_ray = 4,  ///< several tables, their number in a column
};

/// The description block's texts, in the file's order.
enum class Tm25Text {
  light_source,
  manufacturer,
  model_creator,
  ray_file_creator,
  equipment,
  camera,
  operation,
  additional_information,
  data_reference,
};

/// The header of an IES TM-25-13 ray file, field by field. Numbers that are absent are NaN in the file.
/// Positions are in mm, wavelengths in nm.
/// @from  IES TM-25-13 section 4.7, by TM25RaySetTools (J. Muschaweck, Unlicense)
struct Tm25Header {
  std::int32_t creation_method = 0;    ///< 0 simulation, 1 measurement
  std::optional<float> luminous_flux;  ///< lm, of all rays
  std::optional<float> radiant_flux;   ///< W, of all rays
  std::uint64_t ray_count = 0;         ///< writers fill it in
  std::string date;                    ///< ISO 8601, up to 28 bytes
  std::int32_t start_position = 0;     ///< 0 unknown; to 7: on which kind of surface the rays begin
  Tm25Spectrum spectrum = Tm25Spectrum::none;
  std::optional<float> wavelength_nm;
  std::optional<float> least_wavelength_nm;
  std::optional<float> greatest_wavelength_nm;
  bool has_radiant_flux =
      true;  ///< this and the next five: columns that rays have beside position and direction
  bool has_wavelength = false;
  bool has_luminous_flux = false;
  bool has_stokes = false;
  bool has_tristimulus = false;
  bool has_spectrum_index = false;
  std::array<std::string, 9> texts;                           ///< UTF-8, by Tm25Text; up to 1000 characters
  std::vector<std::vector<std::pair<float, float>>> spectra;  ///< wavelength in nm, weight
  std::vector<std::string> additional_columns;                ///< labels, UTF-8, up to 128 characters
  std::string additional_text;                                ///< UTF-8

  const std::string& text(Tm25Text which) const { return texts[static_cast<std::size_t>(which)]; }
  std::string& text(Tm25Text which) { return texts[static_cast<std::size_t>(which)]; }
};

/// The names of a ray's numbers, in order: "x", "y", "z", "kx", "ky", "kz", then by the flags "phi" (W),
/// "lambda" (nm), "Tri_Y" (lm), ..., then the additional ones. Each is a 32-bit float.
std::vector<std::string> columns(const Tm25Header& header);

/// A header as read, and what else is known of the file by it.
struct Tm25Reading {
  Tm25Header header;
  std::uint64_t first_ray_byte = 0;
  std::vector<std::string> notes;  ///< what breaks the standard but does no harm
};

/// Whether the bytes begin as a TM-25 file of either byte order does.
bool looks_like_tm25(std::span<const std::byte> bytes);

/// Reads a header. Spectra and texts are kept, not judged.
/// @in    bytes of the whole file; name for messages
/// @fails InputError with file, byte, field and rule: another version or byte order, an end within it,
///        flags that are none, fluxes that are negative or infinite, neither flux, or more than 64 MiB
/// @cost  O(header)
Tm25Reading read_tm25_header(std::span<const std::byte> bytes, const std::string& name);

/// The header's bytes. Texts that are too long are cut.
/// @fails InputError for a date of more than 28 bytes, a spectrum without numbers, or more columns,
///        tables or text than the header can count
std::string tm25_header_bytes(const Tm25Header& header);

}  // namespace catoptric::rayfiles
