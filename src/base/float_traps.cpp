#include "base/float_traps.h"

#ifdef CATOPTRIC_TRAP_FP

#include <cfenv>

namespace catoptric {
namespace {

constexpr int watched = FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW;

}  // namespace

void trap_float_errors() {
  std::feclearexcept(watched);
  feenableexcept(watched);
}

UntrappedFloats::UntrappedFloats() : before_(fegetexcept()) { fedisableexcept(watched); }

UntrappedFloats::~UntrappedFloats() {
  std::feclearexcept(watched);  // a flag that stands would stop the x87's next operation
  feenableexcept(before_);
}

}  // namespace catoptric

#endif
