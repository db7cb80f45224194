#include <fmt/format.h>

#include <cmath>

#include "base/float_traps.h"
#include "rayfiles/detail/byte_reader.h"
#include "rayfiles/detail/tm25_sizes.h"
#include "rayfiles/detail/utf32.h"
#include "rayfiles/tm25_header.h"

namespace catoptric::rayfiles {
namespace {

using detail::ByteReader;
using detail::Tm25Sizes;

constexpr std::uint64_t most_header_bytes = std::uint64_t{64} << 20;

/// What the header's numbers say of the blocks behind it.
struct Counts {
  std::int32_t spectra;
  std::int32_t additional_columns;
  std::int32_t text_bytes;
};

std::optional<float> number(ByteReader& in, std::string_view field) {
  const auto value = in.read<float>(field);
  if (std::isnan(value)) return std::nullopt;
  return value;
}

std::optional<float> flux(ByteReader& in, std::string_view field) {
  const auto value = number(in, field);
  if (value && !(*value >= 0 && std::isfinite(*value)))
    in.refuse(fmt::format("{} is no flux", *value), "it is 0 or more, or NaN when it is absent");
  return value;
}

std::int32_t count(ByteReader& in, std::string_view field) {
  const auto value = in.read<std::int32_t>(field);
  if (value < 0) in.refuse(fmt::format("{} is no count", value), "it is 0 or more", "copy the file again");
  return value;
}

bool flag(ByteReader& in, std::string_view field) {
  const auto value = in.read<std::int32_t>(field);
  if (value != 0 && value != 1)
    in.refuse(fmt::format("{} is no flag", value), "it is 0 or 1", "copy the file again");
  return value == 1;
}

void read_version(ByteReader& in) {
  in.take(4, "file type");
  const auto version = in.read<std::uint32_t>("version");
  if (detail::byte_reversed(version) == detail::tm25_version)
    in.refuse("the file is big-endian", "TM-25 files are little-endian",
              "write it anew with another program");
  if (version != detail::tm25_version)
    in.refuse(fmt::format("version {} is not known", version), "TM-25-13 files have version 2013",
              "export the file as TM-25-13");
}

Counts read_file_block(ByteReader& in, Tm25Reading& reading) {
  Tm25Header& header = reading.header;
  read_version(in);
  header.creation_method = in.read<std::int32_t>("creation method");
  if (header.creation_method != 0 && header.creation_method != 1)
    reading.notes.push_back(fmt::format("creation method {} is neither simulation (0) nor measurement (1)",
                                        header.creation_method));
  header.luminous_flux = flux(in, "total luminous flux");
  header.radiant_flux = flux(in, "total radiant flux");
  header.ray_count = in.read<std::uint64_t>("number of rays");
  if (header.ray_count == 0) in.refuse("there are no rays", "a source has at least one", "");
  header.date = detail::until_nul(in.text(Tm25Sizes::date, "date"));
  header.start_position = in.read<std::int32_t>("ray start position");
  if (header.start_position < 0 || header.start_position > 7)
    reading.notes.push_back(fmt::format("ray start position {} is none of 0 to 7", header.start_position));
  const auto spectrum = in.read<std::int32_t>("spectral data identifier");
  if (spectrum < 0 || spectrum > 4)
    in.refuse(fmt::format("{} is no spectral data identifier", spectrum), "it is one of 0 to 4", "");
  header.spectrum = static_cast<Tm25Spectrum>(spectrum);
  header.wavelength_nm = number(in, "single wavelength");
  header.least_wavelength_nm = number(in, "minimum wavelength");
  header.greatest_wavelength_nm = number(in, "maximum wavelength");
  const std::int32_t spectra = count(in, "number of spectra");
  const std::int32_t additional_columns = count(in, "number of additional ray data items");
  const std::int32_t text_bytes = count(in, "size of the additional text block");
  if (text_bytes % 4 != 0)
    in.refuse(fmt::format("a text of {} bytes is no UTF-32", text_bytes), "a character takes 4 bytes", "");
  in.take(Tm25Sizes::reserved, "reserved");
  return {spectra, additional_columns, text_bytes};
}

void read_flags(ByteReader& in, Tm25Header& header) {
  for (const char* field : {"position flag", "direction flag"})
    if (!flag(in, field)) in.refuse("the flag is not set", "rays have a position and a direction", "");
  header.has_radiant_flux = flag(in, "radiant flux flag");
  header.has_wavelength = flag(in, "wavelength flag");
  header.has_luminous_flux = flag(in, "luminous flux flag");
  if (!header.has_radiant_flux && !header.has_luminous_flux)
    in.refuse("rays have no flux", "the radiant flux flag, the luminous flux flag or both are 1", "");
  header.has_stokes = flag(in, "Stokes flag");
  header.has_tristimulus = flag(in, "tristimulus flag");
  header.has_spectrum_index = flag(in, "spectrum index flag");
}

void read_spectra(ByteReader& in, std::int32_t tables, Tm25Header& header) {
  const std::uint64_t begin = in.next_byte();
  for (std::int32_t table = 1; table <= tables; ++table) {
    const std::string field = fmt::format("spectrum {}", table);
    const std::int32_t pairs = count(in, field);
    if (pairs == 0) in.refuse("the table is empty", "a spectrum has at least one wavelength", "");
    const auto numbers = in.take(std::uint64_t{8} * static_cast<std::uint32_t>(pairs), field);
    auto& spectrum = header.spectra.emplace_back();
    for (std::size_t at = 0; at < numbers.size(); at += 8)
      spectrum.emplace_back(detail::load<float>(numbers.data() + at),
                            detail::load<float>(numbers.data() + at + 4));
  }
  const std::uint64_t odd = (in.next_byte() - begin) % Tm25Sizes::multiple;
  if (odd > 0) in.take(Tm25Sizes::multiple - odd, "what fills the tables up to 32 bytes");
}

void note_contradictions(Tm25Reading& reading) {
  const Tm25Header& header = reading.header;
  const auto note = [&](bool odd, const char* sentence) {
    if (odd) reading.notes.emplace_back(sentence);
  };
  note(header.spectrum == Tm25Spectrum::single_wavelength && !(header.wavelength_nm.value_or(0) > 0),
       "the rays are said to have one wavelength, but the header has none");
  note(header.spectrum == Tm25Spectrum::wavelength_of_ray && !header.has_wavelength,
       "each ray is said to have a wavelength of its own, but there is no such column");
  note((header.spectrum == Tm25Spectrum::table_of_ray) != header.has_spectrum_index,
       "the spectrum index flag contradicts the spectral data identifier");
  note(header.has_stokes && !header.has_radiant_flux, "polarisation is given without radiant flux");
  note(header.has_tristimulus && !header.has_luminous_flux,
       "tristimulus values are given without luminous flux");
}

}  // namespace

Tm25Reading read_tm25_header(std::span<const std::byte> bytes, const std::string& name) {
  const UntrappedFloats absent_numbers_are_nan;
  const bool longer = bytes.size() > most_header_bytes;
  ByteReader in = longer
                      ? ByteReader(bytes.first(most_header_bytes), name, "the header is longer than 64 MiB")
                      : ByteReader(bytes, name);
  Tm25Reading reading;
  Tm25Header& header = reading.header;
  const Counts counts = read_file_block(in, reading);
  read_flags(in, header);
  for (std::string& text : header.texts)
    text = detail::utf8_of_utf32(in.take(Tm25Sizes::text, "description"));
  const std::uint64_t rest =
      12ULL * static_cast<std::uint32_t>(counts.spectra) +
      Tm25Sizes::label * std::uint64_t(static_cast<std::uint32_t>(counts.additional_columns)) +
      static_cast<std::uint32_t>(counts.text_bytes);
  if (rest > most_header_bytes)
    throw InputError({fmt::format("the header would take {} bytes or more", rest), name + ", bytes 76 to 87",
                      fmt::format("headers up to {} MiB are read", most_header_bytes >> 20),
                      "copy the file again"});
  read_spectra(in, counts.spectra, header);
  for (std::int32_t i = 1; i <= counts.additional_columns; ++i)
    header.additional_columns.push_back(
        detail::utf8_of_utf32(in.take(Tm25Sizes::label, fmt::format("label of additional column {}", i))));
  header.additional_text =
      detail::utf8_of_utf32(in.take(static_cast<std::uint32_t>(counts.text_bytes), "additional text block"));
  reading.first_ray_byte = in.next_byte();
  note_contradictions(reading);
  return reading;
}

}  // namespace catoptric::rayfiles
