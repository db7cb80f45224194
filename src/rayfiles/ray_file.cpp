#include "rayfiles/ray_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/contract.h"
#include "base/errors.h"
#include "base/float_traps.h"
#include "rayfiles/detail/little_endian.h"

namespace catoptric::rayfiles {
namespace {

std::size_t place_of(const std::vector<std::string>& names, std::string_view name) {
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

/// Texts of Zemax have no encoding: what is not ASCII becomes a question mark.
std::string printable(std::string text) {
  for (char& c : text)
    if (c < ' ' || c > '~') c = '?';
  return text;
}

}  // namespace

std::shared_ptr<const RayFile> RayFile::open(const std::filesystem::path& file,
                                             std::optional<LightQuantity> wanted) {
  std::shared_ptr<RayFile> opened(new RayFile(file));
  opened->read_header(wanted);
  return opened;
}

void RayFile::read_header(std::optional<LightQuantity> wanted) {
  const UntrappedFloats absent_numbers_are_nan;
  header_.name = file_.name();
  const auto bytes = file_.bytes();
  if (looks_like_tm25(bytes))
    use(read_tm25_header(bytes, file_.name()), wanted);
  else if (looks_like_zemax(bytes))
    use(read_zemax_header(bytes, file_.name()), wanted);
  else
    refuse_format();
  ray_size_ = sizeof(float) * columns_.size();
  require_all_rays();
}

void RayFile::use(Tm25Reading reading, std::optional<LightQuantity> wanted) {
  const Tm25Header& header = reading.header;
  header_.quantity =
      wanted.value_or(header.has_radiant_flux ? LightQuantity::radiant : LightQuantity::luminous);
  const bool radiant = header_.quantity == LightQuantity::radiant;
  if (!(radiant ? header.has_radiant_flux : header.has_luminous_flux)) refuse_flux(*wanted);
  if (header.has_radiant_flux && header.has_luminous_flux)
    reading.notes.push_back(fmt::format("rays have a radiant and a luminous flux; the {} one is read",
                                        radiant ? "radiant" : "luminous"));
  header_.format = "IES TM-25-13";
  header_.title = header.text(Tm25Text::light_source);
  if (const auto total = radiant ? header.radiant_flux : header.luminous_flux) header_.total_flux = *total;
  header_.count = header.ray_count;
  if (header.spectrum == Tm25Spectrum::single_wavelength && header.wavelength_nm.value_or(0) > 0)
    header_.wavelength_nm = header.wavelength_nm;
  header_.notes = std::move(reading.notes);
  columns_ = rayfiles::columns(header);
  flux_column_ = place_of(columns_, radiant ? "phi" : "Tri_Y");
  first_ray_byte_ = reading.first_ray_byte;
  file_header_ = std::move(reading.header);
}

void RayFile::use(ZemaxReading reading, std::optional<LightQuantity> wanted) {
  const ZemaxHeader& header = reading.header;
  header_.quantity = header.flux == ZemaxFlux::watts ? LightQuantity::radiant : LightQuantity::luminous;
  if (wanted && *wanted != header_.quantity) refuse_flux(*wanted);
  header_.format = "Zemax binary";
  header_.title = printable(header.description);
  if (header.ray_set_flux > 0 && std::isfinite(header.ray_set_flux)) header_.total_flux = header.ray_set_flux;
  header_.count = header.ray_count;
  header_.length_unit = symbol(header.unit);
  header_.millimetres_per_unit = millimetres_per(header.unit);
  constexpr double nm_per_um = 1000;
  if (header.rays == ZemaxRays::flux_only && header.wavelength_um > 0 && std::isfinite(header.wavelength_um))
    header_.wavelength_nm = nm_per_um * header.wavelength_um;
  header_.notes = std::move(reading.notes);
  columns_ = rayfiles::columns(header);
  flux_column_ = place_of(columns_, "flux");
  first_ray_byte_ = zemax_header_size;
  file_header_ = std::move(reading.header);
}

void RayFile::require_all_rays() {
  const std::uint64_t bytes = file_.bytes().size() - first_ray_byte_;
  const std::uint64_t whole = bytes / ray_size_;
  if (whole < header_.count)
    throw InputError(
        {fmt::format("the header says {} rays, the file holds {}", header_.count, whole),
         fmt::format("{}, byte {}", file_.name(), file_.bytes().size()),
         fmt::format("{} rays of {} bytes begin at byte {}", header_.count, ray_size_, first_ray_byte_),
         "copy the file again"});
  if (const std::uint64_t more = bytes - header_.count * ray_size_; more > 0)
    header_.notes.push_back(fmt::format("{} bytes behind the last ray are ignored", more));
}

void RayFile::refuse_flux(LightQuantity wanted) const {
  const bool radiant = wanted == LightQuantity::radiant;
  throw InputError({fmt::format("rays have no {} flux", radiant ? "radiant" : "luminous"), file_.name(),
                    fmt::format("they carry {} only", radiant ? "lumens" : "watts"),
                    "ask for the other one"});
}

void RayFile::refuse_format() const {
  const auto bytes = file_.bytes().first(std::min<std::size_t>(file_.bytes().size(), 64));
  const bool text = std::all_of(bytes.begin(), bytes.end(), [](std::byte byte) {
    const auto c = static_cast<char>(byte);
    return (c >= ' ' && c <= '~') || c == '\n' || c == '\r' || c == '\t';
  });
  const std::string_view begin(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const char* hint = "export it as TM-25-13 (.tm25ray) or as Zemax binary (.dat)";
  if (begin.starts_with("LTRF"))
    hint = "it is a LightTools ray file: export it as TM-25-13 (.tm25ray)";
  else if (text)
    hint = "it looks like text: export it in binary, as TM-25-13 (.tm25ray) or Zemax (.dat)";
  throw InputError({"this is no ray file that is known", file_.name(),
                    "TM-25 files begin with \"TM25\", Zemax binary files with the number 1010", hint});
}

const std::byte* RayFile::bytes_of(std::uint64_t i) const {
  CATOPTRIC_EXPECTS(i < header_.count);
  return file_.bytes().data() + first_ray_byte_ + i * ray_size_;
}

float RayFile::stored(std::uint64_t i, std::size_t column) const {
  CATOPTRIC_EXPECTS(column < columns_.size());
  return detail::load<float>(bytes_of(i) + column * sizeof(float));
}

SourceRay RayFile::as_stored(std::uint64_t i) const {
  const std::byte* const bytes = bytes_of(i);
  const auto number = [&](std::size_t column) {
    return static_cast<double>(detail::load<float>(bytes + column * sizeof(float)));
  };
  return {header_.millimetres_per_unit * Vector3(number(0), number(1), number(2)),
          {number(3), number(4), number(5)},
          number(flux_column_)};
}

std::string RayFile::place(std::uint64_t i, RayField field) const {
  const std::size_t column = field == RayField::position    ? 0
                             : field == RayField::direction ? 3
                                                            : flux_column_;
  const std::string name = field == RayField::flux
                               ? columns_[column]
                               : fmt::format("{} to {}", columns_[column], columns_[column + 2]);
  return fmt::format("{}, ray {} (the first is 0), byte {}, {}", file_.name(), i,
                     first_ray_byte_ + i * ray_size_ + column * sizeof(float), name);
}

}  // namespace catoptric::rayfiles
