#pragma once

#include <filesystem>
#include <string>

#include "report/table.h"

namespace catoptric::report {

/// Whether the first line of a file says "x [cm]" or just "x", as other programs look columns up by.
enum class UnitsInHeader { yes, no };

/// The table as comma-separated text: headings, then rows, numbers with as many digits as it takes to read
/// the same double back, "nan", "inf" and "-inf" where they are not finite, nothing where there is no value.
/// @fails InputError when a row is not as long as the headings
/// @from  quoting: RFC 4180 (with a plain line feed)
std::string csv_text(const Table& table, UnitsInHeader units);

/// Writes csv_text, whole or not at all.
/// @fails InputError, IoError
void write_csv(const std::filesystem::path& path, const Table& table, UnitsInHeader units);

}  // namespace catoptric::report
