#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "src/geometry/box.h"
#include "src/terrain/polygon_edges.h"
#include "stream/library/tiling/polygon_names.h"
#include "stream/library/tiling/vector_tiling.h"

namespace spillway::stream {

/// The polygons of a vector file, in its order.
class VectorPolygons final : public VectorTiling {
 public:
  /// As read_named_polygons().
  VectorPolygons(const std::string& pattern, const std::string& polygons);

  void cut(std::span<const Point<2>> line, const TakePiece& take) override;
  void cut_polygon(const PolygonRings& polygon, const TakePart& take) override;
  void find(const Point<2>& place, std::vector<std::size_t>& tiles) override;
  [[nodiscard]] std::string path(std::size_t tile) const override { return paths_[tile]; }
  /// None: any name could be that of a polygon.
  [[nodiscard]] std::vector<std::string> others_than(
      std::vector<std::string> /*paths*/) const override {
    return {};
  }
  [[nodiscard]] std::string crs() const override { return crs_; }

 private:
  [[nodiscard]] std::size_t cell_of(double coordinate, int axis) const;
  void find_near(const Box<2>& box);

  std::string crs_;
  std::vector<std::string> paths_;   ///< by polygon
  std::vector<PolygonRings> rings_;  ///< likewise
  std::vector<PolygonEdges> polygons_;
  Box<2> box_;                                    ///< of all
  std::size_t cells_ = 1;                         ///< rows, and columns, of a grid over the box
  std::vector<std::vector<std::uint32_t>> grid_;  ///< polygons whose boxes meet the cell
  std::vector<std::uint32_t> near_;               ///< found last
};

}  // namespace spillway::stream
