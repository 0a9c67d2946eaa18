#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "src/terrain/polygon_index.h"
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
  void find(const Point<2>& place, std::vector<std::size_t>& tiles) override {
    index_.find(place, tiles);
  }
  [[nodiscard]] std::string path(std::size_t tile) const override { return named_.paths[tile]; }
  /// None: any name could be that of a polygon.
  [[nodiscard]] std::vector<std::string> others_than(
      std::vector<std::string> /*paths*/) const override {
    return {};
  }
  [[nodiscard]] std::string crs() const override { return named_.crs; }

 private:
  NamedPolygons named_;
  PolygonIndex index_;
};

}  // namespace spillway::stream
