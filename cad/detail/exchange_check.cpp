#include "cad/detail/exchange_check.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/errors.h"
#include "base/whole_file.h"

namespace catoptric::cad::detail {
namespace {

std::string content_of(const std::filesystem::path& file) {
  std::variant<std::string, ErrorParts> read = read_whole_file(file);
  if (ErrorParts* defect = std::get_if<ErrorParts>(&read)) throw CadError(std::move(*defect));
  std::string content = std::get<std::string>(std::move(read));
  if (content.find_first_not_of(" \t\r\n") == std::string::npos)
    throw CadError({"the file is empty", file.string(), "", "export it again"});
  return content;
}

std::vector<std::string_view> lines_of(std::string_view content) {
  std::vector<std::string_view> lines;
  while (!content.empty()) {
    const std::size_t end = content.find_first_of("\r\n");
    if (end != 0) lines.push_back(content.substr(0, end));
    if (end == std::string_view::npos) break;
    content.remove_prefix(end + 1);
  }
  return lines;
}

char section_of(std::string_view line) { return line.size() > 72 ? line[72] : ' '; }

[[noreturn]] void broken(const std::filesystem::path& file, std::size_t line, std::string why) {
  throw CadError({"the IGES file is broken", fmt::format("{}, line {}", file.string(), line), std::move(why),
                  "export it again, and copy it as it is"});
}

/// An integer in eight columns, blank for 0.
std::optional<long> integer_field(std::string_view line, std::size_t column) {
  std::string_view field = line.substr(column, 8);
  while (!field.empty() && field.front() == ' ') field.remove_prefix(1);
  while (!field.empty() && field.back() == ' ') field.remove_suffix(1);
  if (field.empty()) return 0;
  long value = 0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc() || end != field.data() + field.size()) return std::nullopt;
  return value;
}

struct Sections {
  std::array<std::size_t, 5> counts{};  ///< of S, G, D, P, T
  std::size_t first_of_directory = 0;
};

/// Counts the sections and sees to their order.
Sections count_sections(const std::vector<std::string_view>& lines, const std::filesystem::path& file) {
  constexpr std::string_view letters = "SGDPT";
  Sections sections;
  std::size_t current = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (sections.counts[4] > 0) break;  // some writers leave padding after the end
    const std::size_t section = letters.find(section_of(lines[i]));
    if (section == std::string_view::npos || section < current)
      broken(file, i + 1, "column 73 of every line names its section: S, G, D, P, T in this order");
    if (section == 2 && sections.counts[2] == 0) sections.first_of_directory = i;
    current = section;
    ++sections.counts[section];
  }
  if (sections.counts[4] == 0) broken(file, lines.size(), "its end (section T) is missing");
  if (sections.counts[2] == 0 || sections.counts[2] % 2 != 0)
    broken(file, lines.size(), "directory entries have two lines each, and there is at least one");
  return sections;
}

}  // namespace

ExchangeKind kind_of_file(const std::filesystem::path& file) {
  const std::string content = content_of(file);
  const std::size_t start = content.find_first_not_of(" \t\r\n");
  if (content.compare(start, 13, "ISO-10303-21;") == 0) return ExchangeKind::step;
  const auto lines = lines_of(std::string_view(content).substr(0, 4096));
  if (!lines.empty() && section_of(lines.front()) == 'S') return ExchangeKind::iges;
  if (!lines.empty() && (section_of(lines.front()) == 'B' || section_of(lines.front()) == 'C'))
    throw CadError({"binary and compressed IGES are not read", file.string(), "", "export it as text"});
  throw CadError({"this is neither an IGES nor a STEP file", file.string(),
                  "STEP begins with ISO-10303-21; and IGES has an S in column 73",
                  "export the profile as .igs or .step"});
}

void check_step_layout(const std::filesystem::path& file) {
  const std::string content = content_of(file);
  const std::size_t end = content.rfind("END-ISO-10303-21;");
  if (end == std::string::npos)
    throw CadError({"the STEP file is broken", file.string(), "its end (END-ISO-10303-21;) is missing",
                    "export it again, and copy it as it is"});
  if (content.find("DATA;") == std::string::npos && content.find("DATA(") == std::string::npos)
    throw CadError({"the STEP file is broken", file.string(), "it has no DATA section", "export it again"});
}

void check_iges_layout(const std::filesystem::path& file) {
  const std::string content = content_of(file);
  const auto lines = lines_of(content);
  const Sections sections = count_sections(lines, file);
  const auto directory = static_cast<long>(sections.counts[2]);
  const auto parameters = static_cast<long>(sections.counts[3]);
  for (std::size_t i = 0; i < sections.counts[2]; i += 2) {
    const std::size_t row = sections.first_of_directory + i;
    const auto type = integer_field(lines[row], 0), pointer = integer_field(lines[row], 8);
    const auto matrix = integer_field(lines[row], 48), count = integer_field(lines[row + 1], 24);
    if (!type || !pointer || !matrix || !count) broken(file, row + 1, "a directory entry holds no number");
    if (*type != 0 &&
        (*pointer < 1 || *count < 0 || *count > parameters || *pointer + *count - 1 > parameters))
      broken(file, row + 1, "a directory entry points outside the parameter section");
    if (*matrix < 0 || *matrix > directory || (*matrix != 0 && *matrix % 2 == 0))
      broken(file, row + 1, "a directory entry points to no matrix");
  }
}

}  // namespace catoptric::cad::detail
