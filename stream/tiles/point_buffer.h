#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "src/geometry/point.h"

namespace spillway::detail {

/// Points waiting in memory, in the order in which they came, in pieces of one size: growing never
/// copies, and what is let go of goes back to the system.
class PointBuffer {
 public:
  /// Points in one piece; large enough to be memory of its own for the system.
  static constexpr std::size_t kPiece = 4096;

  /// `index` is empty or as long as `points`, and always the same of both for one buffer.
  void append(std::span<const Point<3>> points, std::span<const std::uint64_t> index) {
    while (!points.empty()) {
      if (pieces_.empty() || pieces_.back().size == kPiece) pieces_.push_back(make_piece(index));
      Piece& piece = pieces_.back();
      const std::size_t count = std::min(points.size(), kPiece - piece.size);
      std::copy_n(points.begin(), count, piece.points.get() + piece.size);
      if (!index.empty()) {
        std::copy_n(index.begin(), count, piece.index.get() + piece.size);
        index = index.subspan(count);
      }
      piece.size += count;
      points = points.subspan(count);
    }
  }

  [[nodiscard]] std::size_t size() const {
    return pieces_.empty() ? 0 : (pieces_.size() - 1) * kPiece + pieces_.back().size;
  }

  /// Number of points that it has memory for.
  [[nodiscard]] std::size_t room() const { return pieces_.size() * kPiece; }

  /// Calls f(points, index) for every piece in order and lets go of it.
  template <typename F>
  void drain(F&& f) {
    for (Piece& piece : pieces_) {
      f(std::span<const Point<3>>(piece.points.get(), piece.size),
        piece.index ? std::span<const std::uint64_t>(piece.index.get(), piece.size)
                    : std::span<const std::uint64_t>());
      piece = {};
    }
    pieces_.clear();
  }

 private:
  struct Piece {
    std::unique_ptr<Point<3>[]> points;
    std::unique_ptr<std::uint64_t[]> index;
    std::size_t size = 0;
  };

  static Piece make_piece(std::span<const std::uint64_t> index) {
    return {std::make_unique_for_overwrite<Point<3>[]>(kPiece),
            index.empty() ? nullptr : std::make_unique_for_overwrite<std::uint64_t[]>(kPiece), 0};
  }

  std::vector<Piece> pieces_;
};

}  // namespace spillway::detail
