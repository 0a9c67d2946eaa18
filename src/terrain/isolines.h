#pragma once
// Where the surface of a triangle crosses levels of height: docs/contour.md.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "src/geometry/point.h"
#include "src/terrain/line_shape.h"

namespace spillway::terrain {

/// The heights at which lines are drawn: all multiples of an interval above and below a base, or
/// the heights of a list. A level's number says which one it is.
class Levels {
 public:
  /// Throws InvalidArgument unless the interval is positive and both numbers are finite.
  static Levels every(double interval, double base);
  /// Throws InvalidArgument unless there is one at least and all are finite.
  static Levels of_list(std::vector<double> heights);

  [[nodiscard]] double height(std::int64_t number) const;
  /// Whether there is a level of that number: of a list not every one is.
  [[nodiscard]] bool has(std::int64_t number) const;
  /// The lesser one of the distances to the levels above and below; infinite if there are none.
  [[nodiscard]] double distance_to_next(std::int64_t number) const;
  /// Whether a level is one of every so many, counted from the base; of a list none is.
  [[nodiscard]] bool is_index(std::int64_t number, std::uint64_t every) const;

  /// Numbers of the levels above `low` and up to `high`: from first, before end.
  struct Range {
    std::int64_t first = 0;
    std::int64_t end = 0;
  };
  [[nodiscard]] Range between(double low, double high) const;

 private:
  /// The least number whose level is above `low`.
  [[nodiscard]] std::int64_t first_above(double low) const;

  double interval_ = 0;  ///< 0: the list counts
  double base_ = 0;
  std::vector<double> list_;  ///< ascending
};

/// A place where a level crosses an edge: the same from both triangles of the edge.
struct Crossing {
  std::array<std::uint64_t, 2> edge{};  ///< numbers of its ends, the lesser first
  std::int64_t level = 0;
  bool operator==(const Crossing&) const = default;
};

/// Where a level crosses the edge between two points, the same in either order. One of them is on
/// the level or above it, the other one below.
Point<2> crossing_point(const Point<3>& one, const Point<3>& other, double height);

/// A corner of a triangle, by its number in the mesh and in output coordinates.
struct Corner {
  std::uint64_t number = 0;
  Point<3> point{};
};

/// A level's way through a triangle, higher ground to its left. A corner exactly on the level
/// counts as above it; so every level that crosses a triangle comes in over one edge and leaves
/// over another, and level triangles have no line.
struct IsoSegment {
  Crossing from;
  Crossing to;
  Portal from_portal;
  Portal to_portal;
};

/// Appends the segments of all levels in a triangle whose corners run counter-clockwise. Portals
/// reach no farther than `slide`, and less far than half of the way to the next level and to the
/// ends of the edge. Throws Failure if there are more than a million of them: the interval must be
/// a mistake.
void append_segments(const std::array<Corner, 3>& corners, const Levels& levels, double slide,
                     std::vector<IsoSegment>& segments);

}  // namespace spillway::terrain
