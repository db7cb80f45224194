#include "report/csv.h"

#include <fmt/format.h>

#include "base/atomic_file.h"

namespace catoptric::report {
namespace {

std::string in_quotes(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string inside;
  for (char c : text) inside += c == '"' ? std::string("\"\"") : std::string(1, c);
  return '"' + inside + '"';
}

std::string field(const Cell& cell) {
  if (const auto* number = std::get_if<double>(&cell)) return fmt::format("{}", *number);
  if (const auto* count = std::get_if<long long>(&cell)) return fmt::format("{}", *count);
  if (const auto* text = std::get_if<std::string>(&cell)) return in_quotes(*text);
  return "";
}

}  // namespace

std::string csv_text(const Table& table, UnitsInHeader units) {
  require_rectangular(table);
  std::string text;
  const auto append = [&text](std::size_t column, const std::string& content) {
    if (column) text += ',';
    text += content;
  };
  for (std::size_t i = 0; i < table.columns.size(); ++i)
    append(i, in_quotes(units == UnitsInHeader::yes ? heading(table.columns[i]) : table.columns[i].name));
  text += '\n';
  for (const auto& row : table.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) append(i, field(row[i]));
    text += '\n';
  }
  return text;
}

void write_csv(const std::filesystem::path& path, const Table& table, UnitsInHeader units) {
  write_file_whole(path, csv_text(table, units));
}

}  // namespace catoptric::report
