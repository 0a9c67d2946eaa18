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

/// Points waiting in memory, in the order in which they came, in chunks: growing never copies, and
/// what is let go of goes back to the system. There is room for at most twice as many points as
/// there are, but for the first ones.
class PointBuffer {
 public:
  /// Most points in one chunk; large enough to be memory of its own for the system.
  static constexpr std::size_t kChunk = 4096;

  /// `index` is empty or as long as `points`, and always the same of both for one buffer.
  void append(std::span<const LatticePoint> points, std::span<const std::uint64_t> index) {
    size_ += points.size();
    while (!points.empty()) {
      if (chunks_.empty() || chunks_.back().size == chunks_.back().room) {
        chunks_.push_back(make_chunk(std::clamp(room_, kLeastChunk, kChunk), !index.empty()));
        room_ += chunks_.back().room;
      }
      Chunk& chunk = chunks_.back();
      const std::size_t count = std::min(points.size(), chunk.room - chunk.size);
      std::copy_n(points.begin(), count, chunk.points.get() + chunk.size);
      if (!index.empty()) {
        std::copy_n(index.begin(), count, chunk.index.get() + chunk.size);
        index = index.subspan(count);
      }
      chunk.size += count;
      points = points.subspan(count);
    }
  }

  [[nodiscard]] std::size_t size() const { return size_; }

  /// Number of points that it has memory for.
  [[nodiscard]] std::size_t room() const { return room_; }

  /// Calls f(points) for every chunk in order.
  template <typename F>
  void visit(F&& f) const {
    for (const Chunk& chunk : chunks_) {
      f(std::span<const LatticePoint>(chunk.points.get(), chunk.size));
    }
  }

  /// Calls f(points, index) for every chunk in order and lets go of it.
  template <typename F>
  void drain(F&& f) {
    for (Chunk& chunk : chunks_) {
      f(std::span<const LatticePoint>(chunk.points.get(), chunk.size),
        chunk.index ? std::span<const std::uint64_t>(chunk.index.get(), chunk.size)
                    : std::span<const std::uint64_t>());
      chunk = {};
    }
    *this = {};
  }

 private:
  static constexpr std::size_t kLeastChunk = 64;

  struct Chunk {
    std::unique_ptr<LatticePoint[]> points;
    std::unique_ptr<std::uint64_t[]> index;
    std::size_t room = 0;
    std::size_t size = 0;
  };

  static Chunk make_chunk(std::size_t room, bool indexed) {
    return {std::make_unique_for_overwrite<LatticePoint[]>(room),
            indexed ? std::make_unique_for_overwrite<std::uint64_t[]>(room) : nullptr, room, 0};
  }

  std::vector<Chunk> chunks_;
  std::size_t size_ = 0;
  std::size_t room_ = 0;
};

}  // namespace spillway::detail
