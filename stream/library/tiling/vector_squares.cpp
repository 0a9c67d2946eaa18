#include "stream/library/tiling/vector_squares.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "formats/gdal/gdal.h"
#include "src/error.h"
#include "src/terrain/polygon_edges.h"

namespace spillway::stream {
namespace {

/// A line of more squares, or so many squares away from the origin, is an error.
constexpr double kMostSquaresOfALine = 1e7;
constexpr double kFarthestSquare = 1e15;

}  // namespace

/// Throws InvalidArgument where the side is too small for that.
void VectorSquares::check(std::span<const Point<2>> points) const {
  const Box<2> box = box_of_line(points);
  if (box.empty()) return;
  double farthest = 0;
  double squares = 0;
  for (int k = 0; k < 2; ++k) {
    farthest = std::max({farthest, std::abs(box.lo[k]), std::abs(box.hi[k])});
    squares += (box.hi[k] - box.lo[k]) / names_.side();
  }
  if (squares <= kMostSquaresOfALine && farthest / names_.side() <= kFarthestSquare) return;
  throw InvalidArgument(
      fmt::format("there would be too many tiles of side {}: choose a larger side", names_.side()));
}

std::size_t VectorSquares::number_of(const GridSquare& square) {
  if (latest_ < squares_.size() && squares_[latest_] == square) return latest_;
  const auto [place, is_new] = numbers_.emplace(square, squares_.size());
  if (is_new) squares_.push_back(square);
  latest_ = place->second;
  return latest_;
}

void VectorSquares::cut(std::span<const Point<2>> line, const TakePiece& take) {
  check(line);
  cut_at_squares(line, names_.side(), [&](GridSquare square, std::span<const Point<2>> piece) {
    take(number_of(square), piece);
  });
}

/// Halves what lies in several squares along an edge of them, again and again.
void VectorSquares::cut_polygon(const PolygonRings& polygon, const TakePart& take) {
  check(polygon.front());
  const Box<2> box = box_of_line(polygon.front());
  const GridSquare first = square_at(box.lo, names_.side());
  GridSquare last = square_at(box.hi, names_.side());
  // What only reaches to the edge of one is not in it.
  const auto corner = [&](std::int64_t number) {
    return static_cast<double>(number) * names_.side();
  };
  if (last.row > first.row && corner(last.row) == box.hi[1]) --last.row;
  if (last.column > first.column && corner(last.column) == box.hi[0]) --last.column;
  if (first == last) return take(number_of(first), polygon);
  const bool is_wide = last.column - first.column > last.row - first.row;
  const int axis = is_wide ? 0 : 1;
  const std::int64_t from = is_wide ? first.column : first.row;
  const std::int64_t to = is_wide ? last.column : last.row;
  const double edge = corner(from + (to - from + 1) / 2);
  for (const bool upper : {false, true}) {
    // Its other sides lie beyond the polygon.
    Box<2> half = box;
    for (int k = 0; k < 2; ++k) {
      half.lo[k] -= names_.side();
      half.hi[k] += names_.side();
    }
    (upper ? half.lo : half.hi)[axis] = edge;
    const PolygonRings area = {
        {half.lo, {half.hi[0], half.lo[1]}, half.hi, {half.lo[0], half.hi[1]}}};
    for (PolygonRings& part : gdal().clip(polygon, area)) {
      for (auto& ring : part) {
        for (Point<2>& point : ring) {  // on the edge exactly, so that there is an end
          point[axis] = upper ? std::max(point[axis], edge) : std::min(point[axis], edge);
        }
      }
      cut_polygon(part, take);
    }
  }
}

void VectorSquares::find(const Point<2>& place, std::vector<std::size_t>& tiles) {
  check({&place, 1});
  tiles.assign({number_of(square_at(place, names_.side()))});
}

}  // namespace spillway::stream
