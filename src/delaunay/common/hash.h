#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "src/delaunay/common/triangulation.h"

namespace spillway::delaunay {

/// A bijection of 64-bit numbers that spreads every bit over all others (the finalizer of Steele,
/// Lea, Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014).
constexpr std::uint64_t mix64(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15U;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9U;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBU;
  return x ^ (x >> 31);
}

/// h(s): the xor of the hashes of a simplex's vertices, so their order does not matter.
template <std::size_t N>
std::uint64_t simplex_hash(const std::array<VertexId, N>& vertices) {
  std::uint64_t hash = 0;
  for (const VertexId v : vertices) hash ^= mix64(v);
  return hash;
}

/// f_i(s) = h(s) xor h(v_i): the hash of the facet opposite the i-th vertex, the same from both of
/// the simplices that share it (Funke, Sanders 2017, section 3).
template <std::size_t N>
std::uint64_t facet_hash(const std::array<VertexId, N>& vertices, int i) {
  return simplex_hash(vertices) ^ mix64(vertices[i]);
}

/// Vertices in ascending order, and whether an even permutation brings them there. Without
/// branches.
template <std::size_t N>
struct SortedVertices {
  std::array<VertexId, N> vertices;
  bool even = true;

  explicit SortedVertices(const std::array<VertexId, N>& unsorted) : vertices(unsorted) {
    for (std::size_t end = N; end > 1; --end) {
      for (std::size_t i = 1; i < end; ++i) {
        VertexId& low = vertices[i - 1];
        VertexId& high = vertices[i];
        const VertexId lower = low < high ? low : high;
        even ^= low != lower;
        high = low < high ? high : low;
        low = lower;
      }
    }
  }

  bool operator==(const SortedVertices&) const = default;
};

/// Whether two simplices have the same vertices and orientation: an infinite simplex of the
/// border's triangulation may have the vertices of a child's, but face the other way.
template <std::size_t N>
bool same_simplex(const std::array<VertexId, N>& a, const std::array<VertexId, N>& b) {
  VertexId difference = 0;  // mostly enough to tell two that met in a hash index by chance
  for (std::size_t i = 0; i < N; ++i) difference ^= a[i] ^ b[i];
  return difference == 0 && SortedVertices<N>(a) == SortedVertices<N>(b);
}

/// A hash index of items kept elsewhere, filled and searched by many threads at once, but not
/// filled and searched at the same time. Items are known by their number; hashes may collide, so
/// whoever searches compares the items themselves. Open addressing, at most half full.
class ConcurrentIndex {
 public:
  explicit ConcurrentIndex(std::size_t capacity) {
    while (mask_ < 2 * capacity) mask_ = 2 * mask_ + 1;
    slots_ = std::make_unique<std::atomic<std::uint32_t>[]>(mask_ + 1);
  }

  void insert(std::uint64_t hash, std::uint32_t item) {
    for (std::size_t slot = hash & mask_;; slot = (slot + 1) & mask_) {
      std::uint32_t empty = 0;
      if (slots_[slot].load(std::memory_order_relaxed) == 0 &&
          slots_[slot].compare_exchange_strong(empty, item + 1, std::memory_order_relaxed)) {
        return;
      }
    }
  }

  static constexpr std::uint32_t kNotFound = ~std::uint32_t{0};

  /// Fetches what a search for this hash reads first.
  void prefetch(std::uint64_t hash) const { __builtin_prefetch(&slots_[hash & mask_]); }

  /// The item that a search for this hash looks at first, or kNotFound.
  [[nodiscard]] std::uint32_t first(std::uint64_t hash) const {
    return slots_[hash & mask_].load(std::memory_order_relaxed) - 1;
  }

  /// The item of this hash for which equal(item) holds, or kNotFound.
  template <typename Equal>
  [[nodiscard]] std::uint32_t find(std::uint64_t hash, const Equal& equal) const {
    for (std::size_t slot = hash & mask_;; slot = (slot + 1) & mask_) {
      const std::uint32_t item = slots_[slot].load(std::memory_order_relaxed);
      if (item == 0) return kNotFound;
      if (equal(item - 1)) return item - 1;
    }
  }

 private:
  std::size_t mask_ = 15;
  std::unique_ptr<std::atomic<std::uint32_t>[]> slots_;
};

}  // namespace spillway::delaunay
