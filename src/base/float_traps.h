#pragma once

namespace catoptric {

// A floating-point operation without a meaning (0 / 0, the root of -1, an ordered comparison with NaN), a
// division by zero or an overflow stops a program built with CATOPTRIC_TRAP_FP at that very operation. Other
// builds compile none of this.
#ifdef CATOPTRIC_TRAP_FP

/// From here on this thread and those it starts are stopped by such operations.
void trap_float_errors();

/// While it lives this thread may compute NaN and infinity: around calls into libraries that do so by design,
/// and where our own code says why it does.
class UntrappedFloats {
 public:
  UntrappedFloats();
  ~UntrappedFloats();
  UntrappedFloats(const UntrappedFloats&) = delete;
  UntrappedFloats& operator=(const UntrappedFloats&) = delete;

 private:
  int before_;
};

/// Within a library that may compute NaN and infinity, while it calls our code back: traps again, where the
/// program has them at all.
class TrappedFloats {
 public:
  TrappedFloats();
  ~TrappedFloats();
  TrappedFloats(const TrappedFloats&) = delete;
  TrappedFloats& operator=(const TrappedFloats&) = delete;

 private:
  int before_;
};

#else

inline void trap_float_errors() {}

struct [[maybe_unused]] UntrappedFloats {
  UntrappedFloats() {}
};

struct [[maybe_unused]] TrappedFloats {
  TrappedFloats() {}
};

#endif

}  // namespace catoptric
