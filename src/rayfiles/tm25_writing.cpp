#include <fmt/format.h>

#include <limits>

#include "base/errors.h"
#include "rayfiles/detail/little_endian.h"
#include "rayfiles/detail/tm25_sizes.h"
#include "rayfiles/detail/utf32.h"
#include "rayfiles/tm25_header.h"

namespace catoptric::rayfiles {
namespace {

using detail::append;
using detail::Tm25Sizes;

/// The standard asks for a signalling NaN; its bits, since a float that is passed on may lose them.
void append_number(std::string& bytes, std::optional<float> value) {
  constexpr std::uint32_t signalling_nan = 0x7FA00000;
  if (value)
    append(bytes, *value);
  else
    append(bytes, signalling_nan);
}

/// A text in a block of fixed size, with a NUL behind it unless it takes all of the block.
void append_text(std::string& bytes, const std::string& text, std::size_t size) {
  std::string block = detail::utf32_of_utf8(text);
  block.resize(size, '\0');
  bytes += block;
}

std::int32_t counted(std::size_t count, const char* what) {
  constexpr std::size_t most = std::numeric_limits<std::int32_t>::max();
  if (count > most)
    throw InputError({fmt::format("{} {}", count, what), "TM-25 header",
                      fmt::format("at most {} are possible", most), ""});
  return static_cast<std::int32_t>(count);
}

void append_flags(std::string& bytes, const Tm25Header& header) {
  for (const bool flag :
       {true, true, header.has_radiant_flux, header.has_wavelength, header.has_luminous_flux,
        header.has_stokes, header.has_tristimulus, header.has_spectrum_index})
    append(bytes, std::int32_t{flag});
}

void append_spectra(std::string& bytes, const Tm25Header& header) {
  const std::size_t begin = bytes.size();
  for (const auto& spectrum : header.spectra) {
    if (spectrum.empty())
      throw InputError(
          {"the table of a spectrum is empty", "TM-25 header", "it has at least one wavelength", ""});
    append(bytes, counted(spectrum.size(), "wavelengths in a spectrum"));
    for (const auto& [wavelength_nm, weight] : spectrum) {
      append(bytes, wavelength_nm);
      append(bytes, weight);
    }
  }
  const std::size_t odd = (bytes.size() - begin) % Tm25Sizes::multiple;
  if (odd > 0) bytes.append(Tm25Sizes::multiple - odd, '\0');
}

}  // namespace

std::string tm25_header_bytes(const Tm25Header& header) {
  if (header.date.size() > Tm25Sizes::date)
    throw InputError(
        {"the date is too long", "TM-25 header", "it takes 28 bytes at most", "2013-09-04T08:30:29+01:00"});
  std::string text = detail::utf32_of_utf8(header.additional_text);
  text.resize((text.size() + Tm25Sizes::multiple - 1) / Tm25Sizes::multiple * Tm25Sizes::multiple, '\0');

  std::string bytes = "TM25";
  append(bytes, std::int32_t{detail::tm25_version});
  append(bytes, header.creation_method);
  append_number(bytes, header.luminous_flux);
  append_number(bytes, header.radiant_flux);
  append(bytes, header.ray_count);
  bytes += header.date;
  bytes.append(Tm25Sizes::date - header.date.size(), '\0');
  append(bytes, header.start_position);
  append(bytes, static_cast<std::int32_t>(header.spectrum));
  append_number(bytes, header.wavelength_nm);
  append_number(bytes, header.least_wavelength_nm);
  append_number(bytes, header.greatest_wavelength_nm);
  append(bytes, counted(header.spectra.size(), "spectra"));
  append(bytes, counted(header.additional_columns.size(), "additional columns"));
  append(bytes, counted(text.size(), "bytes of additional text"));
  bytes.append(Tm25Sizes::reserved, '\0');
  append_flags(bytes, header);
  for (const std::string& description : header.texts) append_text(bytes, description, Tm25Sizes::text);
  append_spectra(bytes, header);
  for (const std::string& label : header.additional_columns) append_text(bytes, label, Tm25Sizes::label);
  return bytes + text;
}

}  // namespace catoptric::rayfiles
