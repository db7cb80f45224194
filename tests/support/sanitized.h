#pragma once

extern "C" void __asan_init() __attribute__((weak));

namespace catoptric::test {

/// Whether the rooms under test are watched by the address sanitizer. Tests are compiled once for all,
/// so that only the linker knows.
inline bool address_sanitized() { return __asan_init != nullptr; }

}  // namespace catoptric::test
