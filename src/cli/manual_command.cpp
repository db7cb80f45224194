#include <fmt/format.h>

#include "cli/manual.h"

namespace catoptric::cli {

ExitCode manual_command(const ManualOptions& options) {
  fmt::print("{}", options.scene ? scene_manual() : program_manual(program_words()));
  return ExitCode::done;
}

}  // namespace catoptric::cli
