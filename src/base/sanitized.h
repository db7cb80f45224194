#pragma once

/// Defined where the address sanitizer is built in, which GCC and clang each say in their own way.
#if defined(__SANITIZE_ADDRESS__)
#define CATOPTRIC_ADDRESS_SANITIZED
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define CATOPTRIC_ADDRESS_SANITIZED
#endif
#endif
