#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "src/geometry/box.h"
#include "src/geometry/point.h"

namespace spillway::terrain {

/// Around points of a line or a ring.
Box<2> box_of_line(std::span<const Point<2>> line);

/// A polygon for asking what lies in it, by the even-odd rule over all rings. What lies on an edge
/// belongs to what is east of it, or north of a level one; so of polygons that share their edges,
/// each place is in one.
class PolygonEdges {
 public:
  /// The last point of a ring is joined to the first one.
  explicit PolygonEdges(std::span<const std::vector<Point<2>>> rings);

  [[nodiscard]] const Box<2>& box() const { return box_; }

  /// Exact.
  [[nodiscard]] bool contains(const Point<2>& place) const;

  /// Calls take(points) with each piece of a line that lies in the polygon, in order along it.
  /// Pieces end where the line crosses an edge: a point that does not depend on the directions of
  /// line and edge, so pieces in polygons that share an edge meet. Pieces of a closed line that meet
  /// at its ends are one.
  void cut(std::span<const Point<2>> line,
           const std::function<void(std::span<const Point<2>>)>& take) const;

 private:
  struct Edge {
    Point<2> low;  ///< the end with the lesser y
    Point<2> high;
  };
  /// Edges with a place in a strip from west to east.
  [[nodiscard]] std::span<const std::uint32_t> strip(std::size_t number) const {
    return std::span(edges_of_strips_)
        .subspan(first_of_strip_[number], first_of_strip_[number + 1] - first_of_strip_[number]);
  }
  [[nodiscard]] std::size_t strip_of(double y) const;
  bool find_crossings(const Point<2>& from, const Point<2>& to,
                      std::vector<Point<2>>& crossings) const;

  std::vector<Edge> edges_;
  Box<2> box_;
  std::size_t strips_ = 1;
  std::vector<std::uint32_t> edges_of_strips_;
  std::vector<std::size_t> first_of_strip_;  ///< and the end
};

}  // namespace spillway::terrain
