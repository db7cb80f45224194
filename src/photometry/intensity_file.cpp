#include "photometry/intensity_file.h"

#include <algorithm>
#include <cctype>

#include "base/atomic_file.h"
#include "base/errors.h"
#include "photometry/eulumdat.h"
#include "photometry/file_text.h"
#include "photometry/lm63.h"

namespace catoptric::photometry {
namespace {

std::optional<PhotometricFormat> format_of_ending(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (ending == ".ies") return PhotometricFormat::lm63;
  if (ending == ".ldt") return PhotometricFormat::eulumdat;
  return std::nullopt;
}

[[noreturn]] void refuse_ending(const std::filesystem::path& file) {
  throw InputError({"the format is not known", file.string(), "its ending is .ies or .ldt",
                    "name an IES LM-63 or a EULUMDAT file"});
}

/// Of EULUMDAT the lines 2 and 3 are one digit each.
bool looks_like_eulumdat(std::string_view text) {
  take_line(text);
  for (int i = 0; i < 2; ++i) {
    const std::string_view line = without_blanks(take_line(text));
    if (line.size() != 1 || line[0] < '0' || line[0] > '4') return false;
  }
  return true;
}

bool looks_like_lm63(std::string_view text) {
  if (text.starts_with("IES")) return true;
  constexpr int most_lines = 1000;
  for (int i = 0; i < most_lines && !text.empty(); ++i)
    if (without_blanks(take_line(text)).starts_with("TILT=")) return true;
  return false;
}

MeasuredIntensity of_lm63(Lm63Reading reading) {
  const Lm63File& file = reading.file;
  MeasuredIntensity result{intensity_of(file), std::nullopt, file.input_w, opening_of(file),
                           std::move(reading.notes)};
  if (file.lumens_per_lamp) result.lamp_flux_lm = *file.lumens_per_lamp * file.lamp_count;
  return result;
}

MeasuredIntensity of_eulumdat(EulumdatReading reading) {
  const EulumdatFile& file = reading.file;
  MeasuredIntensity result{intensity_of(file), std::nullopt, file.lamps[0].input_w, opening_of(file),
                           std::move(reading.notes)};
  if (file.lamps[0].count >= 0) result.lamp_flux_lm = file.lamps[0].flux_lm;
  return result;
}

}  // namespace

PhotometricFormat format_of(std::string_view text, const std::filesystem::path& file) {
  if (looks_like_lm63(text)) return PhotometricFormat::lm63;
  if (looks_like_eulumdat(text)) return PhotometricFormat::eulumdat;
  if (const auto format = format_of_ending(file)) return *format;
  refuse_ending(file);
}

MeasuredIntensity read_intensity(const std::filesystem::path& file) {
  std::vector<std::string> notes;
  const std::string text = read_photometric_text(file, notes);
  const PhotometricFormat format = format_of(text, file);
  MeasuredIntensity result =
      format == PhotometricFormat::lm63 ? of_lm63(read_lm63(file)) : of_eulumdat(read_eulumdat(file));
  if (format_of_ending(file).value_or(format) != format)
    result.notes.push_back(format == PhotometricFormat::lm63
                               ? "The file's ending is .ldt, but it is an IES file and was read as one."
                               : "The file's ending is .ies, but it is a EULUMDAT file and was read as one.");
  return result;
}

void write_intensity(const std::filesystem::path& file, const IntensityTable& table,
                     const Luminaire& luminaire) {
  const auto format = format_of_ending(file);
  if (!format) refuse_ending(file);
  write_file_whole(file, *format == PhotometricFormat::lm63 ? lm63_text(lm63_of(table, luminaire))
                                                            : eulumdat_text(eulumdat_of(table, luminaire)));
}

}  // namespace catoptric::photometry
