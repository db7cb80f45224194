#pragma once

#include <string>
#include <variant>
#include <vector>

#include "cli/commands.h"

namespace catoptric::cli {

/// What was asked for.
struct CommandLine {
  std::string command;
  CommonOptions common;
  DesignOptions design;
  LandscapeOptions landscape;
  ProfileOptions profile;
  ExportCommandOptions shape;
  CompletionOptions completion;
  ManualOptions manual;
};

/// @out   what was asked for, or how the program ends where help or version were, which is printed
/// @fails UsageError, with the command or option that may have been meant
std::variant<CommandLine, ExitCode> parse(int argc, char** argv);

/// The command line in words, for its manual page and for shells that complete it.
struct OptionWords {
  std::string name;   ///< "--set", or "SCENE.toml" where it has no name
  std::string value;  ///< "KEY=VALUE"; empty: it takes none
  std::string meaning;
  std::vector<std::string> choices;
};
struct CommandWords {
  std::string name, meaning, footer;
  std::vector<OptionWords> options;
};
struct ProgramWords {
  std::string meaning, footer;
  std::vector<OptionWords> options;
  std::vector<CommandWords> commands;
};
ProgramWords program_words();

}  // namespace catoptric::cli
