#pragma once

#include <functional>

#include "base/ranks.h"

namespace catoptric {

/// A task's result or its error as bytes, so that the error reaches other processes too.
Bytes result_or_error(const std::function<Bytes()>& compute);

/// Whether an error is kept there.
bool is_error(const Bytes& result);

/// The result.
/// @fails with the error where one is kept: InputError, CadError, IoError or Interrupted as it was;
///        std::runtime_error with its words for any other
Bytes result_of(Bytes kept);

}  // namespace catoptric
