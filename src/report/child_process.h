#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace catoptric::report {

/// What a child process left.
struct ChildResult {
  enum class End { finished, not_found, timed_out, failed };
  End end;
  int exit_code = 0;   ///< when finished; 128 + signal when a signal ended it
  std::string output;  ///< its standard output
  std::string errors;  ///< its standard error, or why it could not be started
};

/// Runs a program, looked up in PATH, without a shell, with no standard input and in the C locale, and
/// collects what it prints. It is killed when the time is over.
/// @in    command: the program, then its arguments
ChildResult run_child(const std::vector<std::string>& command, std::chrono::milliseconds time_limit);

}  // namespace catoptric::report
