#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "src/geometry/framed_point.h"

namespace spillway::detail {

/// Points waiting in memory, in the order in which they came, in chunks of one size: growing never
/// copies, and what is let go of goes back to the system.
class PointBuffer {
 public:
  /// Points in one chunk; large enough to be memory of its own for the system.
  static constexpr std::size_t kChunk = 4096;

  /// `index` is empty or as long as `points`, and always the same of both for one buffer.
  void append(std::span<const LatticePoint> points, std::span<const std::uint64_t> index) {
    while (!points.empty()) {
      if (chunks_.empty() || chunks_.back().size == kChunk) chunks_.push_back(make_chunk(index));
      Chunk& chunk = chunks_.back();
      const std::size_t count = std::min(points.size(), kChunk - chunk.size);
      std::copy_n(points.begin(), count, chunk.points.get() + chunk.size);
      if (!index.empty()) {
        std::copy_n(index.begin(), count, chunk.index.get() + chunk.size);
        index = index.subspan(count);
      }
      chunk.size += count;
      points = points.subspan(count);
    }
  }

  [[nodiscard]] std::size_t size() const {
    return chunks_.empty() ? 0 : (chunks_.size() - 1) * kChunk + chunks_.back().size;
  }

  /// Number of points that it has memory for.
  [[nodiscard]] std::size_t room() const { return chunks_.size() * kChunk; }

  /// Calls f(points, index) for every chunk in order and lets go of it.
  template <typename F>
  void drain(F&& f) {
    for (Chunk& chunk : chunks_) {
      f(std::span<const LatticePoint>(chunk.points.get(), chunk.size),
        chunk.index ? std::span<const std::uint64_t>(chunk.index.get(), chunk.size)
                    : std::span<const std::uint64_t>());
      chunk = {};
    }
    chunks_.clear();
  }

 private:
  struct Chunk {
    std::unique_ptr<LatticePoint[]> points;
    std::unique_ptr<std::uint64_t[]> index;
    std::size_t size = 0;
  };

  static Chunk make_chunk(std::span<const std::uint64_t> index) {
    return {std::make_unique_for_overwrite<LatticePoint[]>(kChunk),
            index.empty() ? nullptr : std::make_unique_for_overwrite<std::uint64_t[]>(kChunk), 0};
  }

  std::vector<Chunk> chunks_;
};

}  // namespace spillway::detail
