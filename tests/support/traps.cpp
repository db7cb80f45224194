#include "base/float_traps.h"

namespace {

/// Before any test, in builds that have traps at all.
[[maybe_unused]] const bool set = (catoptric::trap_float_errors(), true);

}  // namespace
