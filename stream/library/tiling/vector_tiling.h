#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "formats/gdal/polygon_layer.h"
#include "src/geometry/point.h"
#include "stream/library/tiling/mesh_tiling.h"

namespace spillway::stream {

/// How lines and polygons are dealt into files, too.
class VectorTiling : public MeshTiling {
 public:
  using TakePiece = std::function<void(std::size_t, std::span<const Point<2>>)>;
  using TakePart = std::function<void(std::size_t, const PolygonRings&)>;

  /// Cuts a line at the edges of tiles, and calls take(tile, points) with each piece. Pieces in
  /// tiles that share an edge meet. Throws InvalidArgument for too many tiles.
  virtual void cut(std::span<const Point<2>> line, const TakePiece& take) = 0;
  /// Cuts a polygon, its outer ring first, likewise; parts are so, too. Throws Failure for polygons
  /// that cross themselves.
  virtual void cut_polygon(const PolygonRings& polygon, const TakePart& take) = 0;
};

/// Squares of a side above 0, or the polygons of a vector file, for files of a pattern; null for
/// neither. Throws InvalidArgument if the pattern does not go with that, and Failure if polygons
/// cannot be read.
std::unique_ptr<VectorTiling> make_vector_tiling(const std::string& pattern, double side,
                                                 const std::string& polygons);

}  // namespace spillway::stream
