#pragma once
// Doubles in lanes, two or four at a time, in the compiler's own notation, so that one text serves
// every processor. Everything here is inlined into the function that uses it and takes that
// function's instruction set. Sources for processors with AVX2 only define SPILLWAY_AVX2.

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "src/rooms.h"

// Inlined even where the caller has more lanes than the rest of the program.
#define SPILLWAY_INLINE [[gnu::always_inline]] inline

/// Compiles a function for processors that have more than the others.
#ifdef __x86_64__
#define SPILLWAY_TARGET(set) [[gnu::target(set)]]
#else
#define SPILLWAY_TARGET(set)
#endif

namespace spillway::delaunay::kernel {

template <int kLanes>
struct LaneTypes;
template <>
struct LaneTypes<2> {
  using Reals [[gnu::vector_size(16)]] = double;
  using Integers [[gnu::vector_size(16)]] = std::int64_t;
  using Bits [[gnu::vector_size(16)]] = std::uint64_t;
};
template <>
struct LaneTypes<4> {
  using Reals [[gnu::vector_size(32)]] = double;
  using Integers [[gnu::vector_size(32)]] = std::int64_t;
  using Bits [[gnu::vector_size(32)]] = std::uint64_t;
};
template <int kLanes>
using Reals = typename LaneTypes<kLanes>::Reals;
template <int kLanes>
using Integers = typename LaneTypes<kLanes>::Integers;

template <int kLanes>
using Bits = typename LaneTypes<kLanes>::Bits;

template <typename V>
SPILLWAY_INLINE void load(const void* from, V& vector) {
  std::memcpy(&vector, from, sizeof(V));
}

template <typename V>
SPILLWAY_INLINE void store(const V& vector, void* to) {
  std::memcpy(to, &vector, sizeof(V));
}

/// Four numbers of 32 bits: a cell's vertices, or its neighbours.
using Words [[gnu::vector_size(16)]] = std::uint32_t;
/// The same bits, for instructions that exist for floating-point numbers only.
using Floats [[gnu::vector_size(16)]] = float;

/// Whether words can be shuffled by a mask that is not a constant, on processors that have
/// kLanes lanes of doubles; others would do it one by one.
template <int kLanes>
inline constexpr bool kShufflesWords = kLanes > 2;

/// The words at these positions, on such processors.
SPILLWAY_INLINE void shuffle(Words& words, const std::uint32_t* positions) {
#ifdef SPILLWAY_AVX2
  using Indices [[gnu::vector_size(16)]] = int;
  Indices mask;
  load(positions, mask);
  words = (Words)__builtin_ia32_vpermilvarps((Floats)words, mask);
#else
  words = Words{words[positions[0]], words[positions[1]], words[positions[2]], words[positions[3]]};
#endif
}

/// Of four words, those whose bit is set, one after the other.
struct WordPacker {
  alignas(16) std::array<std::array<std::uint32_t, 4>, 16> positions{};
  std::array<std::uint8_t, 16> counts{};

  constexpr WordPacker() {
    for (std::uint32_t bits = 0; bits < 16; ++bits) {
      for (std::uint32_t k = 0; k < 4; ++k) {
        if ((bits >> k & 1) != 0) positions[bits][counts[bits]++] = k;
      }
    }
  }
};
inline constexpr WordPacker kWordPacker;

/// Appends those of the words whose bit is set to a list with room for four more. Returns how many
/// the list has then.
template <int kLanes>
SPILLWAY_INLINE std::size_t append(Words words, std::uint32_t bits, std::uint32_t* list,
                                   std::size_t size) {
  if constexpr (kShufflesWords<kLanes>) {
    shuffle(words, kWordPacker.positions[bits].data());
    store(words, list + size);
    return size + kWordPacker.counts[bits];
  } else {
    for (int k = 0; k < 4; ++k) {
      list[size] = words[k];
      size += bits >> k & 1;
    }
    return size;
  }
}

/// Four numbers for each lane: a point and its order key, or a sphere.
template <int kLanes>
struct Records {
  Reals<kLanes> x, y, z, w;
};

/// The bits of the lanes that are true (or negative), the first one lowest.
SPILLWAY_INLINE std::uint32_t mask_of(const Reals<2>& v) {
#ifdef __SSE2__
  return static_cast<std::uint32_t>(__builtin_ia32_movmskpd(v));
#else
  Integers<2> bits;
  std::memcpy(&bits, &v, sizeof v);
  return static_cast<std::uint32_t>((bits[0] < 0 ? 1 : 0) | (bits[1] < 0 ? 2 : 0));
#endif
}

SPILLWAY_INLINE std::uint32_t mask_of(const Words& v) {
#ifdef __SSE2__
  return static_cast<std::uint32_t>(__builtin_ia32_movmskps((Floats)v));
#else
  return v[0] >> 31 | v[1] >> 31 << 1 | v[2] >> 31 << 2 | v[3] >> 31 << 3;
#endif
}

SPILLWAY_INLINE std::uint32_t mask_of(const Reals<4>& v) {
#ifdef SPILLWAY_AVX2
  return static_cast<std::uint32_t>(__builtin_ia32_movmskpd256(v));
#else
  const Reals<2> low = __builtin_shufflevector(v, v, 0, 1);
  const Reals<2> high = __builtin_shufflevector(v, v, 2, 3);
#ifdef __SSE2__
  // The upper halves of all four.
  const auto halves = __builtin_shufflevector((Floats)low, (Floats)high, 1, 3, 5, 7);
  return mask_of((Words)halves);
#else
  return mask_of(low) | mask_of(high) << 2;
#endif
#endif
}

/// The columns of four rows.
SPILLWAY_INLINE void transpose(Reals<4>& a, Reals<4>& b, Reals<4>& c, Reals<4>& d) {
  const Reals<4> ab_even = __builtin_shufflevector(a, b, 0, 4, 2, 6);
  const Reals<4> ab_odd = __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const Reals<4> cd_even = __builtin_shufflevector(c, d, 0, 4, 2, 6);
  const Reals<4> cd_odd = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  a = __builtin_shufflevector(ab_even, cd_even, 0, 1, 4, 5);
  b = __builtin_shufflevector(ab_odd, cd_odd, 0, 1, 4, 5);
  c = __builtin_shufflevector(ab_even, cd_even, 2, 3, 6, 7);
  d = __builtin_shufflevector(ab_odd, cd_odd, 2, 3, 6, 7);
}

/// Two pairs as one vector.
SPILLWAY_INLINE void concatenate(const Reals<2>& low, const Reals<2>& high, Reals<4>& both) {
  both = __builtin_shufflevector(low, high, 0, 1, 2, 3);
}

/// Gathers the records that at(0), at(1), ... point to.
template <int kLanes, typename At>
SPILLWAY_INLINE Records<kLanes> gather(const At& at) {
  Records<kLanes> r;
  if constexpr (kLanes == 2) {
    Reals<2> a_low, a_high, b_low, b_high;
    load(at(0), a_low);
    load(at(0) + 2, a_high);
    load(at(1), b_low);
    load(at(1) + 2, b_high);
    r.x = __builtin_shufflevector(a_low, b_low, 0, 2);
    r.y = __builtin_shufflevector(a_low, b_low, 1, 3);
    r.z = __builtin_shufflevector(a_high, b_high, 0, 2);
    r.w = __builtin_shufflevector(a_high, b_high, 1, 3);
  } else {
    load(at(0), r.x);
    load(at(1), r.y);
    load(at(2), r.z);
    load(at(3), r.w);
    transpose(r.x, r.y, r.z, r.w);
  }
  return r;
}

/// Puts the records where at(0), at(1), ... point to.
template <int kLanes, typename At>
SPILLWAY_INLINE void scatter(const Records<kLanes>& records, const At& at) {
  Records<kLanes> r = records;
  if constexpr (kLanes == 2) {
    store(__builtin_shufflevector(r.x, r.y, 0, 2), at(0));
    store(__builtin_shufflevector(r.z, r.w, 0, 2), at(0) + 2);
    store(__builtin_shufflevector(r.x, r.y, 1, 3), at(1));
    store(__builtin_shufflevector(r.z, r.w, 1, 3), at(1) + 2);
  } else {
    transpose(r.x, r.y, r.z, r.w);
    store(r.x, at(0));
    store(r.y, at(1));
    store(r.z, at(2));
    store(r.w, at(3));
  }
}

}  // namespace spillway::delaunay::kernel

namespace spillway::delaunay::kernel_2d {
using namespace kernel;
}

namespace spillway::delaunay::kernel_3d {
using namespace kernel;
}
