#pragma once

#include "fuzz/targets/picture_check.h"

namespace catoptric::fuzz {

/// PGM and PFM files.
inline void try_netpbm(std::string_view input) { try_picture(input); }

}  // namespace catoptric::fuzz
