#include "base/errors.h"

#include <utility>

namespace catoptric {
namespace {

std::string sentence(const ErrorParts& parts) {
  std::string text = parts.where.empty() ? parts.what : parts.where + ": " + parts.what;
  if (!parts.why.empty()) text += ": " + parts.why;
  if (!parts.hint.empty()) text += ". Try: " + parts.hint;
  return text;
}

}  // namespace

Error::Error(ExitCode code, ErrorParts parts)
    : std::runtime_error(sentence(parts)), code_(code), parts_(std::move(parts)) {}

}  // namespace catoptric
