#pragma once

#include <cstdint>

#include "src/rooms.h"

namespace spillway::formats::laz {

/// `yes` if a < b, else `no`, without a branch: for conditions that no branch predictor knows.
/// Compilers are too fond of branches to be asked in C++.
[[gnu::always_inline]] inline std::uint32_t select_if_below(std::uint32_t a, std::uint32_t b,
                                                            std::uint32_t yes, std::uint32_t no) {
#if defined(__x86_64__) && defined(__GNUC__)
  asm("cmpl %[b], %[a]\n\tcmovbl %[yes], %[no]"
      : [no] "+r"(no)
      : [a] "r"(a), [b] "rm"(b), [yes] "r"(yes)
      : "cc");
  return no;
#else
  return a < b ? yes : no;
#endif
}

}  // namespace spillway::formats::laz
