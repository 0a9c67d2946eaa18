#pragma once

#include "src/rooms.h"
// Plain loops as vector code for the processor that the program runs on.

#ifdef __x86_64__
// Compiles a function, with all that it calls, for processors with AVX2.
#define SPILLWAY_FOR_AVX2 [[gnu::target("avx2"), gnu::flatten]]
#define SPILLWAY_HAS_AVX2 __builtin_cpu_supports("avx2")
#else
#define SPILLWAY_FOR_AVX2
#define SPILLWAY_HAS_AVX2 false
#endif

namespace spillway::formats {

template <typename Work>
SPILLWAY_FOR_AVX2 void with_avx2(const Work& work) {
  work();
}

/// Calls work(), in which the compiler may use AVX2 where the processor has it. Bits are the same.
template <typename Work>
void with_longest_vectors(const Work& work) {
  SPILLWAY_HAS_AVX2 ? with_avx2(work) : work();
}

}  // namespace spillway::formats

#undef SPILLWAY_FOR_AVX2
#undef SPILLWAY_HAS_AVX2
