#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "src/delaunay/kernel_nd/simplices.h"
#include "src/geometry/point.h"

namespace spillway::delaunay::kernel_nd {

/// Finds the simplices of a star that are neighbours: a hash table of their facets that have the
/// star's point, each by its other D - 1 vertices. Every facet is in just two simplices.
template <int D>
class RidgeTable {
 public:
  __extension__ using Key = unsigned __int128;
  /// Of a vertex in a key, which is exact.
  static constexpr int kVertexBits = std::min(32, 128 / (D - 1));

  static constexpr Facet kNone = ~Facet{0};

  /// Begins a star of so many simplices.
  void begin(std::size_t simplices) {
    const std::size_t size = std::bit_ceil(D * simplices + 1);  // twice as many as there are facets
    if (size > entries_.size()) entries_.assign(size, {});
    mask_ = size - 1;
    ++star_;
  }

  /// The facet that has the same vertices, or kNone; then this one will be found.
  Facet match(Key key, Facet facet) {
    std::size_t place = hash(key) & mask_;
    while (entries_[place].star == star_) {
      if (entries_[place].key == key) return entries_[place].facet;
      place = (place + 1) & mask_;
    }
    entries_[place] = {key, facet, star_};
    return kNone;
  }

 private:
  struct Entry {
    Key key = 0;
    Facet facet = 0;
    std::uint32_t star = 0;
  };

  static std::size_t hash(Key key) {
    constexpr std::uint64_t kLow = 0x9E3779B97F4A7C15U;
    constexpr std::uint64_t kHigh = 0xC2B2AE3D27D4EB4FU;
    std::uint64_t h = static_cast<std::uint64_t>(key) * kLow;
    h ^= std::rotl(static_cast<std::uint64_t>(key >> 64) * kHigh, 29);
    h ^= h >> 32;
    h *= kLow;
    return h >> 29;
  }

  std::vector<Entry> entries_;
  std::size_t mask_ = 0;
  std::uint32_t star_ = 0;
};

/// Calls visit(key, slot) for each facet of a new simplex but that in `point_slot`, opposite to the
/// star's point.
template <int D, typename Visit>
SPILLWAY_INLINE void for_each_ridge(const std::array<VertexId, D + 1>& vertices, int point_slot,
                                    const Visit& visit) {
  using Table = RidgeTable<D>;
  constexpr int kSlotBits = SimplexArray<D>::kNumberShift;
  std::array<std::uint32_t, D> sorted;
  for (int slot = 0, n = 0; slot <= D; ++slot) {
    if (slot == point_slot) continue;
    const std::uint32_t word = vertices[slot] << kSlotBits | static_cast<std::uint32_t>(slot);
    int place = n++;
    for (; place > 0 && sorted[place - 1] > word; --place) sorted[place] = sorted[place - 1];
    sorted[place] = word;
  }
  for (int left_out = 0; left_out < D; ++left_out) {
    typename Table::Key key = 0;
    for (int i = 0; i < D; ++i) {
      if (i != left_out) key = key << Table::kVertexBits | sorted[i] >> kSlotBits;
    }
    visit(key, static_cast<int>(sorted[left_out] & ((1U << kSlotBits) - 1)));
  }
}

}  // namespace spillway::delaunay::kernel_nd
