#pragma once

#include <cmath>
#include <string_view>

#include "cad/detail/profile_packet.h"
#include "fuzz/support/accepted.h"

namespace catoptric::fuzz {

/// What a reading process sends back, after it may have lost its mind.
inline void try_packet(std::string_view input) {
  accepted([&] {
    const cad::ImportedProfile got = cad::detail::unpack_profile(std::string(input), "file.step");
    if (!(got.profile.diagonal_mm() < HUGE_VAL)) finding("a profile without a size");
    if (!(cad::detail::unpack_profile(cad::detail::pack_profile(got), "file.step").profile == got.profile))
      finding("another profile");
  });
}

}  // namespace catoptric::fuzz
