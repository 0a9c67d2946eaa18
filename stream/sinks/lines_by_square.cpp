#include "stream/sinks/lines_by_square.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "src/error.h"
#include "src/geometry/box.h"
#include "stream/sinks/line_store.h"

namespace spillway::stream {

namespace {

/// What a square takes besides its pieces.
constexpr std::uint64_t kSquareBytes = 256;

/// A line of more squares, or so many squares away from the origin, is an error.
constexpr double kMostSquaresOfALine = 1e7;
constexpr double kFarthestSquare = 1e15;

}  // namespace

/// Throws InvalidArgument where the side is too small for that.
void LinesBySquare::check(std::span<const Point<2>> points) const {
  Box<2> box;
  for (const Point<2>& point : points) box.expand(point);
  if (box.empty()) return;
  double farthest = 0;
  double squares = 0;
  for (int k = 0; k < 2; ++k) {
    farthest = std::max({farthest, std::abs(box.lo[k]), std::abs(box.hi[k])});
    squares += (box.hi[k] - box.lo[k]) / side_;
  }
  if (squares <= kMostSquaresOfALine && farthest / side_ <= kFarthestSquare &&
      squares_.size() * kSquareBytes <= memory_) {
    return;
  }
  throw InvalidArgument(fmt::format(
      "lines would be cut into too many tiles of side {}: choose a larger side, or more memory",
      side_));
}

void LinesBySquare::add(std::span<const Point<2>> points, std::int64_t level) {
  check(points);
  cut_at_squares(points, side_, [&](GridSquare square, std::span<const Point<2>> piece) {
    Packer& latest = squares_[square].latest;
    const std::size_t before = latest.bytes().size();
    latest.put(level);
    latest.put_list(piece);
    in_memory_ += latest.bytes().size() - before;
  });
  if (in_memory_ > memory_) spill();
}

void LinesBySquare::spill() {
  if (!file_) file_ = scratch_.create("lines");
  for (auto& [square, pieces] : squares_) {
    const std::vector<std::byte> bytes = pieces.latest.take();
    if (bytes.empty()) continue;
    pieces.spilled.push_back({file_->size(), bytes.size()});
    file_->append(bytes);
  }
  in_memory_ = 0;
}

std::vector<GridSquare> LinesBySquare::squares() const {
  std::vector<GridSquare> squares;
  for (const auto& [square, pieces] : squares_) squares.push_back(square);
  return squares;
}

void LinesBySquare::for_each(
    GridSquare square,
    const std::function<void(std::span<const Point<2>>, std::int64_t)>& take) const {
  const Pieces& pieces = squares_.at(square);
  std::vector<std::byte> bytes;
  for (const Batch& batch : pieces.spilled) {
    bytes.resize(batch.bytes);
    file_->read(batch.offset, bytes);
    LineStore::for_each(bytes, take);
  }
  LineStore::for_each(pieces.latest.bytes(), take);
}

}  // namespace spillway::stream
