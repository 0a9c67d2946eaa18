#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "src/geometry/box.h"
#include "src/terrain/polygon_edges.h"

namespace spillway::terrain {

/// Many polygons, for asking which of them a place lies in, and which are near a box.
class PolygonIndex {
 public:
  PolygonIndex() : PolygonIndex(std::vector<PolygonEdges>()) {}
  explicit PolygonIndex(std::vector<PolygonEdges> polygons);

  /// Around all of them.
  [[nodiscard]] const Box<2>& box() const { return box_; }
  [[nodiscard]] const PolygonEdges& polygon(std::size_t number) const { return polygons_[number]; }

  /// Whether any has the place.
  [[nodiscard]] bool contains(const Point<2>& place) const;
  /// Replaces `found` by the numbers of those that have the place, ascending.
  void find(const Point<2>& place, std::vector<std::size_t>& found) const;
  /// The numbers of those whose boxes may meet a box, ascending.
  [[nodiscard]] std::vector<std::uint32_t> near(const Box<2>& box) const;

 private:
  [[nodiscard]] std::size_t cell_of(double coordinate, int axis) const;
  [[nodiscard]] const std::vector<std::uint32_t>& cell(std::size_t row, std::size_t column) const {
    return grid_[row * cells_ + column];
  }

  std::vector<PolygonEdges> polygons_;
  Box<2> box_;
  std::size_t cells_ = 1;                         ///< rows, and columns, of a grid over the box
  std::vector<std::vector<std::uint32_t>> grid_;  ///< polygons whose boxes meet the cell
};

}  // namespace spillway::terrain
