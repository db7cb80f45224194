#pragma once

#include <stdexcept>
#include <string>

namespace catoptric {

/// How the program ends; the numbers are fixed, other programs rely on them.
enum class ExitCode {
  done = 0,
  our_bug = 1,
  usage = 2,
  scene_invalid = 3,
  geometry_or_exchange = 4,
  unconverged = 5,
  cannot_write = 6,
  interrupted = 130,
};

/// What a message to the user consists of. Empty parts are left out of the text.
struct ErrorParts {
  std::string what;   ///< the problem
  std::string where;  ///< file, line, key, entity
  std::string why;    ///< the rule that is broken
  std::string hint;   ///< what to try
};

/// An error that a person can act on. what() is "where: what: why. Try: hint".
class Error : public std::runtime_error {
 public:
  Error(ExitCode code, ErrorParts parts);
  ExitCode exit_code() const { return code_; }
  const ErrorParts& parts() const { return parts_; }

 private:
  ExitCode code_;
  ErrorParts parts_;
};

/// The user's scene, data file or option value is invalid (exit 3).
class InputError : public Error {
 public:
  explicit InputError(ErrorParts parts) : Error(ExitCode::scene_invalid, std::move(parts)) {}
};

/// The command line is wrong (exit 2).
class UsageError : public Error {
 public:
  explicit UsageError(ErrorParts parts) : Error(ExitCode::usage, std::move(parts)) {}
};

/// Geometry that cannot be built, or an exchange file that cannot be read or lost something (exit 4).
class CadError : public Error {
 public:
  explicit CadError(ErrorParts parts) : Error(ExitCode::geometry_or_exchange, std::move(parts)) {}
};

/// A file that cannot be written (exit 6).
class IoError : public Error {
 public:
  explicit IoError(ErrorParts parts) : Error(ExitCode::cannot_write, std::move(parts)) {}
};

/// The user asked to stop, and there is nothing to show for it (exit 130).
class Interrupted : public Error {
 public:
  Interrupted() : Error(ExitCode::interrupted, {"interrupted", "", "nothing was written", ""}) {}
};

}  // namespace catoptric
