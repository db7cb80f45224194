#pragma once

#include <filesystem>

#include "cad/detail/exchange_check.h"
#include "cad/profile_import.h"

namespace catoptric::cad::detail {

/// What import_profile() does in its child: a broken file may kill the process.
/// @fails CadError
ImportedProfile import_here(const std::filesystem::path& file, ExchangeKind kind,
                            const ImportOptions& options);

}  // namespace catoptric::cad::detail
