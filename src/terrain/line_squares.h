#pragma once

#include <compare>
#include <cstdint>
#include <functional>
#include <span>

#include "src/geometry/point.h"

namespace spillway::terrain {

/// A square of a grid whose edges lie on multiples of its side, counted from the origin to the
/// north and to the east. It holds its southern and western edges.
struct GridSquare {
  std::int64_t row = 0;
  std::int64_t column = 0;

  // NOLINTNEXTLINE(modernize-use-nullptr): a false finding in what the compiler generates
  auto operator<=>(const GridSquare&) const = default;  // NOLINT(modernize-use-nullptr)
};

/// The square of a side that a place lies in, by the edges as they are computed.
GridSquare square_at(const Point<2>& place, double side);

/// Cuts a line where it crosses edges of squares of a side, and calls take(square, points) with
/// each piece, in order along the line. Pieces share the points at which they are cut, which lie on
/// the edge exactly and do not depend on the line's direction. Pieces of a closed line that meet at
/// its ends are one.
void cut_at_squares(std::span<const Point<2>> line, double side,
                    const std::function<void(GridSquare, std::span<const Point<2>>)>& take);

}  // namespace spillway::terrain
