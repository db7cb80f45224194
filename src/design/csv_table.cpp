#include "design/csv_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/errors.h"
#include "design/toml_values.h"

namespace catoptric::design {
namespace {

std::string_view trimmed(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> cells;
  while (true) {
    const auto comma = line.find(',');
    cells.push_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

std::string without_unit(std::string_view name) {
  if (name.size() >= 2 && name.front() == '"' && name.back() == '"') name = name.substr(1, name.size() - 2);
  for (const char open : {'[', '('}) name = name.substr(0, name.find(open));
  return std::string(trimmed(name));
}

/// `where` is asked only when the cell holds none: a table may have millions.
template <typename Where>
double number(std::string_view cell, Where&& where) {
  double value = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc{} || end != cell.data() + cell.size() || !std::isfinite(value))
    throw InputError({fmt::format("\"{}\" is no finite number", shortened(cell)), where(),
                      "columns are separated by commas, decimals by a point", "check the line"});
  return value;
}

}  // namespace

CsvTable parse_csv_table(std::string_view text, const std::string& name,
                         const std::vector<std::string>& ignored) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // byte order mark of spreadsheet programs
  CsvTable table;
  std::vector<std::string> headings;
  const auto skipped = [&](std::size_t i) {
    return std::find(ignored.begin(), ignored.end(), headings[i]) != ignored.end();
  };
  for (std::size_t line_number = 1; !text.empty(); ++line_number) {
    const auto end = text.find('\n');
    const std::string_view line = trimmed(text.substr(0, end));
    text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
    if (line.empty() || line.front() == '#') continue;
    const auto cells = split(line);
    if (headings.empty()) {
      for (const auto cell : cells) headings.push_back(without_unit(cell));
      for (std::size_t i = 0; i < headings.size(); ++i)
        if (!skipped(i)) table.names.push_back(headings[i]);
      table.columns.resize(table.names.size());
      continue;
    }
    if (cells.size() != headings.size())
      throw InputError({fmt::format("{} cells under {} headings", cells.size(), headings.size()),
                        fmt::format("{}:{}", name, line_number), "every row has one number for each column",
                        ""});
    for (std::size_t i = 0, next = 0; i < cells.size(); ++i)
      if (!skipped(i))
        table.columns[next++].push_back(number(cells[i], [&] {
          return fmt::format("{}:{}, column {}", name, line_number, shortened(headings[i]));
        }));
    table.lines.push_back(line_number);
  }
  if (table.lines.empty())
    throw InputError(
        {"the table has no rows", name, "a header line and rows of numbers are needed", "x,y,z,irradiance"});
  return table;
}

CsvTable read_csv_table(const std::filesystem::path& file, const std::vector<std::string>& ignored) {
  return parse_csv_table(read_text(file), file.string(), ignored);
}

const std::vector<double>& column(const CsvTable& table, std::string_view name, const std::string& file) {
  const auto count = std::count(table.names.begin(), table.names.end(), name);
  if (count > 1)
    throw InputError({fmt::format("{} columns are named \"{}\"", count, name), file,
                      "it must be plain which one is meant", "rename or remove the others"});
  if (count == 0)
    throw InputError({fmt::format("there is no column \"{}\"", shortened(name)), file,
                      "its columns are " + shortened(fmt::format("{}", fmt::join(table.names, ", "))),
                      "rename one, or set target.column"});
  const auto place = std::find(table.names.begin(), table.names.end(), name) - table.names.begin();
  return table.columns[static_cast<std::size_t>(place)];
}

void check_range(const CsvTable& table, const std::vector<double>& values, double least, double greatest,
                 std::string_view what, const std::string& file) {
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!(values[i] >= least && values[i] <= greatest))
      throw InputError({fmt::format("{} {} is out of range", what, values[i]),
                        fmt::format("{}:{}", file, table.lines[i]),
                        fmt::format("it lies between {} and {}", least, greatest), "check the table's unit"});
}

}  // namespace catoptric::design
