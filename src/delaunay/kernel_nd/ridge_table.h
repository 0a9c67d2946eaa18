#pragma once
// How the simplices of a star find their neighbours among each other.

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "src/delaunay/kernel_nd/simplices.h"
#include "src/geometry/point.h"

namespace spillway::delaunay::kernel_nd {

__extension__ using Bits128 = unsigned __int128;

/// A hash table of the facets of a star's simplices that have the star's point, each by a key that
/// names its other D - 1 vertices exactly and is not 0. Every one is a facet of just two simplices.
template <typename Key>
class RidgeTable {
 public:
  /// Begins a star that has so many of these facets, counted twice.
  void begin(std::size_t facets) {
    const std::size_t size = 2 * std::bit_ceil(facets + 1);  // at most a quarter of it will be full
    if (size > keys_.size()) {
      keys_.resize(size);
      facets_.resize(size);
    }
    std::fill_n(keys_.begin(), size, 0);
    shift_ = 64 - std::countr_zero(size);
  }

  /// The facet of this key that was given before, or, the first time, the same one. Without a
  /// branch on that, which nobody could predict.
  SPILLWAY_INLINE Facet match(Key key, Facet facet) {
    std::uint64_t place = hash(key) >> shift_;
    Key there = keys_[place];
    while (static_cast<int>(there != 0) & static_cast<int>(there != key)) {
      place = (place + 1) & (~std::uint64_t{0} >> shift_);
      there = keys_[place];
    }
    const Facet known = -static_cast<Facet>(there == key);  // all bits, or none
    const Facet other = (facets_[place] & known) | (facet & ~known);
    keys_[place] = key;
    facets_[place] = facet;
    return other;
  }

 private:
  static std::uint64_t hash(Key key) {
    constexpr std::uint64_t kFactor = 0x9E3779B97F4A7C15U;
    auto h = static_cast<std::uint64_t>(key) * kFactor;
    if constexpr (sizeof(Key) > sizeof h) {
      h ^= std::rotl(static_cast<std::uint64_t>(key >> 64) * 0xC2B2AE3D27D4EB4FU, 29);
    }
    return h;
  }

  std::vector<Key> keys_;
  std::vector<Facet> facets_;
  int shift_ = 63;
};

/// Numbers the vertices of a star's boundary, from 0, so that sets of them are bits of a word.
class StarVertices {
 public:
  explicit StarVertices(std::size_t vertices) : entries_(vertices) {}

  void begin() {
    ++star_;
    count_ = 0;
  }
  /// The number of a vertex, the next one if it has none yet.
  std::uint32_t number(VertexId v) {
    Entry& entry = entries_[v];
    if (entry.star != star_) entry = {star_, count_++};
    return entry.number;
  }

  [[nodiscard]] std::uint32_t count() const { return count_; }

 private:
  struct Entry {
    std::uint32_t star = 0;
    std::uint32_t number = 0;
  };

  std::vector<Entry> entries_;
  std::uint32_t star_ = 0;
  std::uint32_t count_ = 0;
};

/// Calls visit(key, slot) for each facet of a new simplex but the one opposite to the star's point,
/// which is the last vertex. A key has a bit for each of the other vertices, whose numbers are
/// given: they are less than a Key has bits.
template <typename Key, int D, typename Visit>
SPILLWAY_INLINE void for_each_ridge(const std::array<std::uint32_t, D>& numbers,
                                    const Visit& visit) {
  Key all = 0;
  for (const std::uint32_t number : numbers) all |= Key{1} << number;
  for (int slot = 0; slot < D; ++slot) visit(all ^ Key{1} << numbers[slot], slot);
}

/// Bits of a vertex in a key of sorted numbers.
template <int D>
inline constexpr int kVertexBits = std::min(32, 128 / (D - 1));

/// The same of any number of vertices. A key has their numbers, sorted.
template <int D, typename Visit>
SPILLWAY_INLINE void for_each_sorted_ridge(const std::array<std::uint32_t, D>& numbers,
                                           const Visit& visit) {
  constexpr int kSlotBits = SimplexArray<D>::kNumberShift;
  std::array<std::uint32_t, D> sorted;
  for (int slot = 0; slot < D; ++slot) {
    const std::uint32_t word = numbers[slot] << kSlotBits | static_cast<std::uint32_t>(slot);
    int place = slot;
    for (; place > 0 && sorted[place - 1] > word; --place) sorted[place] = sorted[place - 1];
    sorted[place] = word;
  }
  for (int left_out = 0; left_out < D; ++left_out) {
    Bits128 key = 0;
    for (int i = 0; i < D; ++i) {
      if (i != left_out) key = key << kVertexBits<D> | sorted[i] >> kSlotBits;
    }
    visit(key, static_cast<int>(sorted[left_out] & ((1U << kSlotBits) - 1)));
  }
}

}  // namespace spillway::delaunay::kernel_nd
