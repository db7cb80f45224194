#pragma once

extern "C" void __asan_init() __attribute__((weak));
extern "C" void __tsan_init() __attribute__((weak));

namespace catoptric::test {

/// Whether the rooms under test are watched by address or thread sanitizer. Tests are compiled once for all,
/// so that only the linker knows.
inline bool address_sanitized() { return __asan_init != nullptr; }
inline bool thread_sanitized() { return __tsan_init != nullptr; }

}  // namespace catoptric::test
