#pragma once

#include <cfenv>
#if defined(__x86_64__)
#include <xmmintrin.h>

#include "src/rooms.h"
#endif

namespace spillway::library {

/// While it lives, the calling thread rounds to the nearest and keeps subnormal numbers, as the
/// proofs of the predicates ask for, whatever a program has set; then all is as before. A program
/// that is linked with -ffast-math, for example, starts with subnormal numbers cut to zero. Threads
/// of with_threads() take over what its caller has.
class FloatEnvironment {
 public:
#if defined(__x86_64__)
  FloatEnvironment() : before_(_mm_getcsr()) {
    if ((before_ & ~kFlags) != kDefault) _mm_setcsr(kDefault);
  }
  ~FloatEnvironment() {
    if ((before_ & ~kFlags) != kDefault) _mm_setcsr(before_);
  }
#else
  FloatEnvironment() {
    std::fegetenv(&before_);
    std::fesetenv(FE_DFL_ENV);
  }
  ~FloatEnvironment() { std::fesetenv(&before_); }
#endif
  FloatEnvironment(const FloatEnvironment&) = delete;
  FloatEnvironment& operator=(const FloatEnvironment&) = delete;

 private:
#if defined(__x86_64__)
  static constexpr unsigned kFlags = 0x3F;      // of exceptions that have been
  static constexpr unsigned kDefault = 0x1F80;  // nearest, all exceptions masked, no flushing
  unsigned before_;
#else
  std::fenv_t before_;
#endif
};

}  // namespace spillway::library
