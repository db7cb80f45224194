#pragma once

#include <filesystem>
#include <string>

#include "cad/profile_import.h"

namespace catoptric::cad::detail {

/// An imported profile as bytes, to be sent from the child process that read it.
std::string pack_profile(const ImportedProfile& imported);

/// The profile that was packed. The sender has read a stranger's file, so nothing it sends is trusted.
/// @fails CadError that names `file`, when the bytes are not a packed profile
ImportedProfile unpack_profile(const std::string& bytes, const std::filesystem::path& file);

}  // namespace catoptric::cad::detail
