#include "report/table.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/errors.h"
#include "report/text.h"

namespace catoptric::report {
namespace {

bool is_number(const Cell& cell) {
  return std::holds_alternative<double>(cell) || std::holds_alternative<long long>(cell);
}

std::string padded(const std::string& text, std::size_t width, bool to_the_right) {
  const std::string blanks(width - std::min(width, width_of(text)), ' ');
  return to_the_right ? blanks + text : text + blanks;
}

std::string joined(const std::vector<std::string>& cells, const std::vector<std::size_t>& widths,
                   const std::vector<bool>& to_the_right) {
  std::string line;
  for (std::size_t i = 0; i < cells.size(); ++i)
    line += (i ? "  " : "") + padded(cells[i], widths[i], to_the_right[i]);
  line.erase(line.find_last_not_of(' ') + 1);
  return line + "\n";
}

}  // namespace

bool holds_numbers(const Table& table, std::size_t column) {
  return std::any_of(table.rows.begin(), table.rows.end(),
                     [&](const auto& row) { return is_number(row[column]); });
}

std::string readable(const Cell& cell, int digits) {
  if (const auto* number = std::get_if<double>(&cell)) return fmt::format("{:.{}g}", *number, digits);
  if (const auto* count = std::get_if<long long>(&cell)) return fmt::format("{}", *count);
  if (const auto* text = std::get_if<std::string>(&cell)) return clean_line(*text);
  return "-";
}

std::string heading(const Column& column) {
  return column.unit.empty() ? column.name : fmt::format("{} [{}]", column.name, column.unit);
}

void require_rectangular(const Table& table) {
  for (std::size_t i = 0; i < table.rows.size(); ++i)
    if (table.rows[i].size() != table.columns.size())
      throw InputError({"the table is not rectangular", fmt::format("row {}", i + 1),
                        fmt::format("{} cells under {} headings", table.rows[i].size(), table.columns.size()),
                        "fill missing cells with an empty value"});
}

std::string text_table(const Table& table) {
  require_rectangular(table);
  std::vector<std::vector<std::string>> lines(table.rows.size() + 1);
  std::vector<std::size_t> widths;
  std::vector<bool> to_the_right;
  for (std::size_t column = 0; column < table.columns.size(); ++column) {
    lines[0].push_back(clean_line(heading(table.columns[column])));
    widths.push_back(width_of(lines[0].back()));
    to_the_right.push_back(holds_numbers(table, column));
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
      lines[row + 1].push_back(readable(table.rows[row][column], table.columns[column].digits));
      widths.back() = std::max(widths.back(), width_of(lines[row + 1].back()));
    }
  }
  std::string text = joined(lines[0], widths, to_the_right);
  std::vector<std::string> rule;
  for (std::size_t width : widths) rule.emplace_back(width, '-');
  text += joined(rule, widths, to_the_right);
  for (std::size_t row = 1; row < lines.size(); ++row) text += joined(lines[row], widths, to_the_right);
  return text;
}

}  // namespace catoptric::report
