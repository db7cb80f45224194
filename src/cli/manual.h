#pragma once

#include <string>

#include "cli/parser.h"

namespace catoptric::cli {

/// The manual page catoptric(1), as roff.
std::string program_manual(const ProgramWords& program);

/// The manual page catoptric-scene(5): every key of a scene file, from the table that validates them.
std::string scene_manual();

}  // namespace catoptric::cli
