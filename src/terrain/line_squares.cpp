#include "src/terrain/line_squares.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace spillway::terrain {
namespace {

std::int64_t number_at(double coordinate, double side) {
  const auto number = static_cast<std::int64_t>(std::floor(coordinate / side));
  if (static_cast<double>(number + 1) * side <= coordinate) return number + 1;
  return static_cast<double>(number) * side > coordinate ? number - 1 : number;
}

/// A coordinate that is a multiple of the side but for rounding becomes that.
double at_corner(double coordinate, double side) {
  constexpr double kRoundingShare = 1e-14;
  const double multiple = std::round(coordinate / side) * side;
  const double most = kRoundingShare * std::max(std::abs(coordinate), side);
  return std::abs(coordinate - multiple) <= most ? multiple : coordinate;
}

/// Where the segment crosses the edges that are multiples along an axis.
void add_crossings(const Point<2>& from, const Point<2>& to, int axis, double side,
                   std::vector<Point<2>>& crossings) {
  // Computed from the lesser end, so that it is the same for the segment turned round.
  const auto& [low, high] = from < to ? std::pair(from, to) : std::pair(to, from);
  const int other = 1 - axis;
  const double least = std::min(from[axis], to[axis]);
  const double greatest = std::max(from[axis], to[axis]);
  for (auto number = static_cast<std::int64_t>(std::floor(least / side)) + 1;; ++number) {
    const double edge = static_cast<double>(number) * side;
    if (edge >= greatest) return;
    if (edge <= least) continue;
    const double share = (edge - low[axis]) / (high[axis] - low[axis]);
    Point<2> crossing;
    crossing[axis] = edge;
    crossing[other] =
        at_corner(std::clamp(low[other] + (high[other] - low[other]) * share,
                             std::min(low[other], high[other]), std::max(low[other], high[other])),
                  side);
    crossings.push_back(crossing);
  }
}

/// All of the segment's points but the first, with those at edges between, in order.
void append_cut(const Point<2>& from, const Point<2>& to, double side,
                std::vector<Point<2>>& points) {
  const std::size_t first = points.size();
  add_crossings(from, to, 0, side, points);
  add_crossings(from, to, 1, side, points);
  const auto along = [&](const Point<2>& p) {
    return std::abs(p[0] - from[0]) + std::abs(p[1] - from[1]);
  };
  std::ranges::sort(points.begin() + static_cast<std::ptrdiff_t>(first), points.end(), {}, along);
  points.push_back(to);
}

/// The square that a stretch between two edges lies in.
GridSquare square_between(const Point<2>& a, const Point<2>& b, double side) {
  return square_at({a[0] + (b[0] - a[0]) / 2, a[1] + (b[1] - a[1]) / 2}, side);
}

struct Piece {
  GridSquare square;
  std::vector<Point<2>> points;
};

}  // namespace

GridSquare square_at(const Point<2>& place, double side) {
  return {number_at(place[1], side), number_at(place[0], side)};
}

void cut_at_squares(std::span<const Point<2>> line, double side,
                    const std::function<void(GridSquare, std::span<const Point<2>>)>& take) {
  if (line.size() < 2) return;
  std::vector<Point<2>> points = {line.front()};
  for (std::size_t i = 1; i < line.size(); ++i) append_cut(line[i - 1], line[i], side, points);
  std::vector<Piece> pieces;
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (points[i] == points[i - 1]) continue;
    const GridSquare square = square_between(points[i - 1], points[i], side);
    if (pieces.empty() || pieces.back().square != square) {
      pieces.push_back({square, {points[i - 1]}});
    }
    pieces.back().points.push_back(points[i]);
  }
  const bool is_closed = line.front() == line.back();
  if (is_closed && pieces.size() > 1 && pieces.front().square == pieces.back().square) {
    std::vector<Point<2>>& last = pieces.back().points;
    last.insert(last.end(), pieces.front().points.begin() + 1, pieces.front().points.end());
    pieces.front().points = std::move(last);
    pieces.pop_back();
  }
  for (const Piece& piece : pieces) take(piece.square, piece.points);
}

}  // namespace spillway::terrain
