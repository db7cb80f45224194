#include "base/task_result.h"

#include <stdexcept>
#include <utility>

#include "base/byte_record.h"
#include "base/errors.h"

namespace catoptric {
namespace {

enum class Kept : char { result, error };

Bytes kept_error(ExitCode code, const ErrorParts& parts) {
  return ByteWriter()
      .put(Kept::error)
      .put(code)
      .put(parts.what)
      .put(parts.where)
      .put(parts.why)
      .put(parts.hint)
      .take();
}

[[noreturn]] void raise(ExitCode code, ErrorParts parts) {
  switch (code) {
    case ExitCode::scene_invalid:
      throw InputError(std::move(parts));
    case ExitCode::usage:
      throw UsageError(std::move(parts));
    case ExitCode::geometry_or_exchange:
      throw CadError(std::move(parts));
    case ExitCode::cannot_write:
      throw IoError(std::move(parts));
    case ExitCode::interrupted:
      throw Interrupted();
    default:
      throw std::runtime_error(parts.what);
  }
}

}  // namespace

Bytes result_or_error(const std::function<Bytes()>& compute) {
  try {
    return std::string(1, static_cast<char>(Kept::result)) + compute();
  } catch (const Error& error) {
    return kept_error(error.exit_code(), error.parts());
  } catch (const std::exception& error) {
    return kept_error(ExitCode::our_bug, {error.what(), "", "", ""});
  }
}

bool is_error(const Bytes& result) {
  return !result.empty() && result.front() == static_cast<char>(Kept::error);
}

Bytes result_of(Bytes kept) {
  ByteReader reader(kept);
  if (reader.get<Kept>() == Kept::result) return kept.substr(1);
  const auto code = reader.get<ExitCode>();
  ErrorParts parts;
  reader.get(parts.what).get(parts.where).get(parts.why).get(parts.hint);
  raise(code, std::move(parts));
}

}  // namespace catoptric
