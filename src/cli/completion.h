#pragma once

#include <string>

#include "cli/parser.h"

namespace catoptric::cli {

/// Scripts by which shells complete commands, options, their choices, keys of scenes and files.
std::string bash_completion(const ProgramWords& program);
std::string zsh_completion(const ProgramWords& program);
std::string fish_completion(const ProgramWords& program);

}  // namespace catoptric::cli
