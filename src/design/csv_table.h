#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace catoptric::design {

/// A table of numbers with named columns, as comma-separated text. Lines that begin with # are comments; a
/// name may carry a unit in brackets, which is not part of it.
struct CsvTable {
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;
  std::vector<std::size_t> lines;  ///< line of each row in the file
};

/// @fails InputError with file, line and column for anything but finite numbers under one header
/// @in    ignored: names of columns that hold text; they are left out
CsvTable read_csv_table(const std::filesystem::path& file, const std::vector<std::string>& ignored = {});
CsvTable parse_csv_table(std::string_view text, const std::string& name,
                         const std::vector<std::string>& ignored = {});

/// The named column.  @fails InputError that lists the columns there are, or when two have the name
const std::vector<double>& column(const CsvTable& table, std::string_view name, const std::string& file);

/// Refuses values outside [least, greatest], with the line of the first.
/// @in    what: "radius", for the message
void check_range(const CsvTable& table, const std::vector<double>& values, double least, double greatest,
                 std::string_view what, const std::string& file);

}  // namespace catoptric::design
