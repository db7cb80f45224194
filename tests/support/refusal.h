#pragma once

#include <catch2/catch.hpp>

#include "base/errors.h"

namespace catoptric::test {

/// Checks that a scene was refused as a user can use it: what, why or what to try, and the exit code of
/// scenes.
inline void check_refusal(const Error& error) {
  CHECK(!error.parts().what.empty());
  CHECK(!(error.parts().why.empty() && error.parts().hint.empty()));
  CHECK(
      (error.exit_code() == ExitCode::scene_invalid || error.exit_code() == ExitCode::geometry_or_exchange));
}

}  // namespace catoptric::test
