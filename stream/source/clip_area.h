#pragma once

#include <optional>
#include <vector>

#include "src/geometry/box.h"
#include "src/terrain/polygon_index.h"

namespace spillway::stream {

/// Polygons of which the inside, or the outside, is wanted. What lies on an edge belongs to what is
/// east of it, or north of a level one.
class ClipArea {
 public:
  ClipArea(std::vector<PolygonEdges> polygons, bool outside)
      : polygons_(std::move(polygons)), outside_(outside) {}

  /// Exact. Safe for many threads at a time.
  [[nodiscard]] bool keeps(const Point<2>& place) const {
    return polygons_.contains(place) != outside_;
  }
  /// A box around all that it keeps; nothing if there is none.
  [[nodiscard]] std::optional<Box<2>> box() const {
    return outside_ ? std::nullopt : std::optional(polygons_.box());
  }

 private:
  PolygonIndex polygons_;
  bool outside_;
};

}  // namespace spillway::stream
