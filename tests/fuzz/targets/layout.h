#pragma once

#include <cmath>
#include <string_view>

#include "cad/detail/exchange_check.h"
#include "fuzz/support/accepted.h"

namespace catoptric::fuzz {

/// What is checked of IGES and STEP files before OpenCASCADE reads them.
inline void try_layout(std::string_view input) {
  static const InputFile file;
  accepted([&] {
    const std::string& path = file.with(input.data(), input.size());
    if (cad::detail::kind_of_file(path) == cad::detail::ExchangeKind::step)
      cad::detail::check_step_layout(path);
    else
      cad::detail::check_iges_layout(path);
  });
}

}  // namespace catoptric::fuzz
