#include <fmt/format.h>

#include "cli/completion.h"

namespace catoptric::cli {

ExitCode completion_command(const CompletionOptions& options) {
  const ProgramWords program = program_words();
  fmt::print("{}", options.shell == "bash"  ? bash_completion(program)
                   : options.shell == "zsh" ? zsh_completion(program)
                                            : fish_completion(program));
  return ExitCode::done;
}

}  // namespace catoptric::cli
