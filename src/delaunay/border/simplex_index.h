#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>

#include "src/delaunay/common/hash.h"
#include "src/parallel/parallel.h"

namespace spillway::delaunay {

/// A hash index of simplices of N vertices that are kept elsewhere. It is filled and searched a
/// batch at a time: what lies far apart in memory is fetched for all before the first is looked at.
template <std::size_t N>
class SimplexIndex {
 public:
  using Corners = std::array<VertexId, N>;
  static constexpr std::size_t kBatch = 32;
  static constexpr std::uint32_t kNotFound = ConcurrentIndex::kNotFound;

  /// Uses all threads.
  explicit SimplexIndex(std::span<const Corners> simplices)
      : simplices_(simplices), index_(simplices.size()) {
    constexpr std::size_t kGrain = 128 * kBatch;
    parallel_for(simplices.size(), kGrain, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t first = begin; first < end; first += kBatch) {
        const auto some = simplices.subspan(first, std::min(kBatch, end - first));
        const Hashes hashes = fetched(some);
        for (std::size_t i = 0; i < some.size(); ++i) {
          index_.insert(hashes[i], static_cast<std::uint32_t>(first + i));
        }
      }
    });
  }

  /// The numbers of the simplices that are the same as these, at most kBatch, or kNotFound.
  [[nodiscard]] std::array<std::uint32_t, kBatch> find(std::span<const Corners> wanted) const {
    assert(wanted.size() <= kBatch);
    const Hashes hashes = fetched(wanted);
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      const std::uint32_t first = index_.first(hashes[i]);
      if (first != kNotFound) __builtin_prefetch(&simplices_[first]);
    }
    std::array<std::uint32_t, kBatch> found;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      found[i] = index_.find(
          hashes[i], [&](std::uint32_t item) { return same_simplex(wanted[i], simplices_[item]); });
    }
    return found;
  }

 private:
  using Hashes = std::array<std::uint64_t, kBatch>;

  /// The hashes of simplices, after fetching what a search for them reads first.
  Hashes fetched(std::span<const Corners> simplices) const {
    Hashes hashes;
    for (std::size_t i = 0; i < simplices.size(); ++i) {
      hashes[i] = simplex_hash(simplices[i]);
      index_.prefetch(hashes[i]);
    }
    return hashes;
  }

  std::span<const Corners> simplices_;
  ConcurrentIndex index_;
};

}  // namespace spillway::delaunay
