// Insertion with four lanes of doubles, for processors that have AVX2, and for those that have
// twice as many registers for them.

// What is not compiled for such processors only comes first.
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <vector>

#ifdef __x86_64__
#include <immintrin.h>

#define SPILLWAY_AVX2
#ifdef __clang__
#pragma clang attribute push(__attribute__((target("avx2,bmi,bmi2"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2,bmi,bmi2")
#endif
#endif

#include "src/delaunay/kernel_3d/insertion_by_lanes.h"

namespace spillway::delaunay::kernel_3d {

template <bool kHasOrderKeys>
void Insertion<kHasOrderKeys>::insert_by_4(VertexRef query, VertexRef next) {
  insert_by<4>(query, next);
}

/// The same text, inlined, takes the instruction set that this function is declared with.
template <bool kHasOrderKeys>
SPILLWAY_TARGET_32_REGISTERS void Insertion<kHasOrderKeys>::insert_by_4_with_32_registers(
    VertexRef query, VertexRef next) {
  insert_by<4>(query, next);
}

template void Insertion<false>::insert_by_4(VertexRef, VertexRef);
template void Insertion<true>::insert_by_4(VertexRef, VertexRef);
template void Insertion<false>::insert_by_4_with_32_registers(VertexRef, VertexRef);
template void Insertion<true>::insert_by_4_with_32_registers(VertexRef, VertexRef);

}  // namespace spillway::delaunay::kernel_3d

#ifdef SPILLWAY_AVX2
#ifdef __clang__
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif
#endif
