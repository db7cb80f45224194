#include "photometry/lm63_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "base/errors.h"
#include "photometry/file_text.h"

namespace catoptric::photometry {
namespace {

struct Edition {
  Lm63Version version;
  std::string_view first_line;
  std::size_t longest_line;  ///< bytes without the line's end; 0: no limit
};

constexpr std::array<Edition, 5> editions{{{Lm63Version::of_1986, "", 132},
                                           {Lm63Version::of_1991, "IESNA91", 132},
                                           {Lm63Version::of_1995, "IESNA:LM-63-1995", 132},
                                           {Lm63Version::of_2002, "IESNA:LM-63-2002", 254},
                                           {Lm63Version::of_2019, "IES:LM-63-2019", 0}}};

std::string upper_case(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return result;
}

/// The edition that a first line names; the first edition has no such line.
const Edition& edition_of(std::string_view line, const std::string& name) {
  const std::string word = upper_case(without_blanks(line));
  for (const Edition& edition : editions)
    if (!edition.first_line.empty() && word == edition.first_line) return edition;
  if (word.starts_with("IESNA:") || word.starts_with("IES:"))
    throw InputError({fmt::format("the edition \"{}\" is not known", cited(line)), name + ":1, first line",
                      "it is IESNA91, IESNA:LM-63-1995, IESNA:LM-63-2002 or IES:LM-63-2019, or there is none",
                      "write the edition that the file follows"});
  return editions[0];
}

/// A line of the form [NAME] value.
bool takes_keyword(std::string_view line, Lm63Keyword& keyword) {
  const auto end = line.find(']');
  if (!line.starts_with('[') || end == std::string_view::npos) return false;
  keyword.name = upper_case(line.substr(1, end - 1));
  keyword.value = without_blanks(line.substr(end + 1));
  return true;
}

void take_label(std::string_view line, Lm63Header& header, std::vector<std::string>& notes,
                std::size_t line_number) {
  if (header.version == Lm63Version::of_1986) {
    header.keywords.push_back({"", std::string(line)});
    return;
  }
  Lm63Keyword keyword;
  if (without_blanks(line).empty()) return;
  if (!takes_keyword(without_blanks(line), keyword)) {
    notes.push_back(fmt::format("Line {} is no keyword in brackets; it was left out.", line_number));
  } else if (keyword.name != "MORE") {
    header.keywords.push_back(std::move(keyword));
  } else if (header.keywords.empty()) {
    notes.push_back(fmt::format("[MORE] in line {} has nothing to continue; it was left out.", line_number));
  } else {
    header.keywords.back().value += '\n' + keyword.value;
  }
}

void note_missing_keywords(const Lm63Header& header, std::vector<std::string>& notes) {
  if (header.version == Lm63Version::of_1986) return;
  std::vector<std::string_view> required{"TEST", "MANUFAC"};
  if (header.version >= Lm63Version::of_2002) required.insert(required.end(), {"TESTLAB", "ISSUEDATE"});
  for (const auto name : required)
    if (std::none_of(header.keywords.begin(), header.keywords.end(),
                     [&](const Lm63Keyword& keyword) { return keyword.name == name; }))
      notes.push_back(
          fmt::format("The keyword [{}] is missing, which {} asks for.", name, first_line(header.version)));
}

}  // namespace

std::string_view first_line(Lm63Version version) {
  return editions[static_cast<std::size_t>(version)].first_line;
}

Lm63Header read_lm63_header(std::string_view text, const std::string& name, std::vector<std::string>& notes) {
  constexpr std::size_t most_lines = 10'000;
  Lm63Header header;
  std::string_view probe = text;
  const Edition& edition = edition_of(take_line(probe), name);
  header.version = edition.version;
  std::size_t line_number = 1;
  if (edition.version != Lm63Version::of_1986) {
    text = probe;
    ++line_number;
  }
  std::size_t long_lines = 0;
  while (!text.empty() && line_number <= most_lines) {
    const std::string_view line = take_line(text);
    if (edition.longest_line > 0 && line.size() > edition.longest_line) ++long_lines;
    const std::string_view trimmed = without_blanks(line);
    if (upper_case(trimmed.substr(0, 5)) == "TILT=") {
      header.tilt = without_blanks(trimmed.substr(5));
      header.rest = text;
      header.rest_line = line_number + 1;
      if (long_lines > 0)
        notes.push_back(fmt::format("{} lines before TILT= are longer than {} bytes, the edition's limit.",
                                    long_lines, edition.longest_line));
      note_missing_keywords(header, notes);
      return header;
    }
    take_label(line, header, notes, line_number);
    ++line_number;
  }
  throw InputError(
      {"there is no line that begins with TILT=", name,
       "one of TILT=NONE, TILT=INCLUDE or TILT= and a file's name ends the header of an IES file",
       "check that it is an IES LM-63 file and is whole"});
}

}  // namespace catoptric::photometry
