#pragma once

#include <cstddef>
#include <string>
#include <variant>
#include <vector>

namespace catoptric::report {

/// A value in a table; std::monostate where there is none.
using Cell = std::variant<std::monostate, double, long long, std::string>;

/// A column's heading. An empty unit means a number without one, or text.
struct Column {
  std::string name;
  std::string unit;
  int digits = 6;  ///< significant digits where a person reads the numbers; files get all of them
};

/// Rows under headings.
struct Table {
  std::vector<Column> columns;
  std::vector<std::vector<Cell>> rows;  ///< each as long as `columns`
};

/// @fails InputError, naming the row, when a row is not as long as the headings
void require_rectangular(const Table& table);

/// The cell as a person reads it: numbers with `digits` significant digits, "-" for none.
std::string readable(const Cell& cell, int digits);

/// "name [unit]", or the name alone.
std::string heading(const Column& column);

/// Whether a column holds at least one number, and so is set to the right.
bool holds_numbers(const Table& table, std::size_t column);

/// The table for a terminal: aligned columns under their headings, numbers to the right, text to the left.
/// @fails InputError when a row is not as long as the headings
std::string text_table(const Table& table);

}  // namespace catoptric::report
