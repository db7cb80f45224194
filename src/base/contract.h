#pragma once

#include <stdexcept>

/// Contracts catch our own mistakes, never the user's; they are checked in the dev, asan and tsan presets.
#ifdef CATOPTRIC_CONTRACTS
#define CATOPTRIC_CONTRACT_(kind, condition)                                                 \
  do {                                                                                       \
    if (!(condition)) throw std::logic_error(kind " broken: " #condition " (" __FILE__ ")"); \
  } while (false)
#else
#define CATOPTRIC_CONTRACT_(kind, condition) static_cast<void>(sizeof(condition))
#endif

#define CATOPTRIC_EXPECTS(condition) CATOPTRIC_CONTRACT_("precondition", condition)
#define CATOPTRIC_ENSURES(condition) CATOPTRIC_CONTRACT_("postcondition", condition)
