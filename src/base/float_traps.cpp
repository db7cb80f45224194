#include "base/float_traps.h"

#ifdef CATOPTRIC_TRAP_FP

#include <cfenv>

namespace catoptric {
namespace {

constexpr int watched = FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW;

int trapped = 0;  ///< set once, before there are threads

/// Traps these, and no others; a flag that stands would stop the x87's next operation.
void trap(int errors) {
  std::feclearexcept(watched);
  fedisableexcept(watched & ~errors);
  feenableexcept(errors);
}

}  // namespace

void trap_float_errors() { trap(trapped = watched); }

UntrappedFloats::UntrappedFloats() : before_(fegetexcept()) { fedisableexcept(watched); }

UntrappedFloats::~UntrappedFloats() { trap(before_); }

TrappedFloats::TrappedFloats() : before_(fegetexcept()) { trap(trapped); }

TrappedFloats::~TrappedFloats() { trap(before_); }

}  // namespace catoptric

#endif
