#include <fmt/format.h>

#include "base/errors.h"
#include "base/units.h"
#include "photometry/file_text.h"
#include "photometry/lm63.h"

namespace catoptric::photometry {
namespace {

constexpr std::string_view line_end = "\r\n";
constexpr std::size_t longest_line = 130;  // bytes: below 132 in any edition

/// Numbers with the shortest text that reads back exactly, wrapped.
class NumberLines {
 public:
  explicit NumberLines(std::string& text) : text_(text) {}

  void add(double value) {
    const std::string word = fmt::format("{}", value);
    if (length_ > 0 && length_ + 1 + word.size() > longest_line) end();
    if (length_ > 0) text_ += ' ';
    text_ += word;
    length_ += word.size() + 1;
  }
  void add_all(const std::vector<double>& values) {
    for (const double value : values) add(value);
    end();
  }
  void end() {
    if (length_ > 0) text_ += line_end;
    length_ = 0;
  }

 private:
  std::string& text_;
  std::size_t length_ = 0;
};

/// The part of a long text that fits into a line, cut at a blank where there is one.
std::string take_part(std::string_view& text, std::size_t most_bytes) {
  std::string part = one_line(text, most_bytes);
  const auto blank = part.rfind(' ');
  if (part.size() < text.size() && blank != std::string::npos && blank > 0) part.resize(blank);
  text.remove_prefix(part.size());
  return std::string(without_blanks(part));
}

void write_keyword(const Lm63Keyword& keyword, std::string& text) {
  const std::string more = "[MORE] ";
  std::string begin = keyword.name.empty() ? "" : fmt::format("[{}] ", one_line(keyword.name, 40));
  std::string_view rest = keyword.value;
  do {
    std::string_view paragraph = take_line(rest);
    do {
      text += begin;
      text += take_part(paragraph, longest_line - begin.size());
      text += line_end;
      if (!keyword.name.empty()) begin = more;
    } while (!paragraph.empty());
  } while (!rest.empty());
}

void write_tilt(const std::optional<Lm63Tilt>& tilt, std::string& text) {
  text += tilt ? "TILT=INCLUDE" : "TILT=NONE";
  text += line_end;
  if (!tilt) return;
  text += fmt::format("{}{}{}{}", tilt->lamp_geometry, line_end, tilt->angles_deg.size(), line_end);
  NumberLines lines(text);
  lines.add_all(tilt->angles_deg);
  lines.add_all(tilt->factors);
}

}  // namespace

Lm63File lm63_of(const IntensityTable& table, const Luminaire& luminaire, Lm63Version version) {
  if (table.quantity() != LightQuantity::luminous)
    throw InputError({"an intensity in W/sr is no candela", "IES file", "IES LM-63 holds photometric data",
                      "convert it with the luminous efficacy of its light first"});
  if (version != Lm63Version::of_2002 && version != Lm63Version::of_2019)
    throw InputError({"this edition is not written", "IES file", "it is 2002 or 2019", "write 2019"});
  Lm63File file;
  file.version = version;
  const auto stated = [](const std::string& text) { return text.empty() ? "not stated" : text; };
  file.keywords = {{"TEST", stated(luminaire.test)},
                   {"TESTLAB", stated(luminaire.laboratory)},
                   {"ISSUEDATE", stated(luminaire.issue_date)},
                   {"MANUFAC", stated(luminaire.manufacturer)},
                   {"LUMCAT", stated(luminaire.catalog)},
                   {"LUMINAIRE", stated(luminaire.name)},
                   {"LAMP", stated(luminaire.lamp)}};
  file.lamp_count = luminaire.lamp_count;
  if (luminaire.lamp_flux_lm) file.lumens_per_lamp = *luminaire.lamp_flux_lm / luminaire.lamp_count;
  const LuminousOpening& opening = luminaire.opening;
  const double mm = (opening.is_round ? -1 : 1) * millimetres_per(LengthUnit::metre);
  if (opening.along_c90_mm > 0) file.width = opening.along_c90_mm / mm;
  if (opening.along_c0_mm > 0) file.length = opening.along_c0_mm / mm;
  file.height = opening.height_mm / millimetres_per(LengthUnit::metre);
  if (version == Lm63Version::of_2019) file.ballast_lamp_factor = simulated_file_code;
  file.input_w = luminaire.input_w;
  file.vertical_deg = table.gamma_deg();
  file.horizontal_deg = table.c_deg();
  file.candela = table.values();
  if (!table.is_rotational()) {  // the first plane closes the turn
    file.horizontal_deg.push_back(360);
    file.candela.insert(file.candela.end(), table.values().begin(),
                        table.values().begin() + static_cast<std::ptrdiff_t>(table.gamma_deg().size()));
  }
  return file;
}

std::string lm63_text(const Lm63File& file) {
  std::string text(first_line(file.version));
  if (!text.empty()) text += line_end;
  for (const Lm63Keyword& keyword : file.keywords) write_keyword(keyword, text);
  write_tilt(file.tilt, text);
  text += fmt::format("{} {} {} {} {} {} {} {} {} {}{}", file.lamp_count, file.lumens_per_lamp.value_or(-1),
                      file.multiplier, file.vertical_deg.size(), file.horizontal_deg.size(),
                      static_cast<int>(file.type), static_cast<int>(file.units), file.width, file.length,
                      file.height, line_end);
  // The code of 2019 has five decimals, which some readers compare as text.
  const std::string lamp_factor = file.ballast_lamp_factor == simulated_file_code
                                      ? fmt::format("{:.5f}", file.ballast_lamp_factor)
                                      : fmt::format("{}", file.ballast_lamp_factor);
  text += fmt::format("{} {} {}{}", file.ballast_factor, lamp_factor, file.input_w, line_end);
  NumberLines lines(text);
  lines.add_all(file.vertical_deg);
  lines.add_all(file.horizontal_deg);
  for (std::size_t i = 0; i < file.candela.size(); ++i) {  // each plane begins a line
    if (i % file.vertical_deg.size() == 0) lines.end();
    lines.add(file.candela[i]);
  }
  lines.end();
  return text;
}

}  // namespace catoptric::photometry
