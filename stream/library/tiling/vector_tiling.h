#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "formats/gdal/polygon_layer.h"
#include "src/geometry/point.h"

namespace spillway::stream {

/// How lines and triangles are dealt into files. Tiles have numbers from 0 on.
class VectorTiling {
 public:
  using TakePiece = std::function<void(std::size_t, std::span<const Point<2>>)>;
  using TakePart = std::function<void(std::size_t, const PolygonRings&)>;

  VectorTiling() = default;
  virtual ~VectorTiling() = default;
  VectorTiling(const VectorTiling&) = delete;
  VectorTiling& operator=(const VectorTiling&) = delete;

  /// Cuts a line at the edges of tiles, and calls take(tile, points) with each piece. Pieces in
  /// tiles that share an edge meet. Throws InvalidArgument for too many tiles.
  virtual void cut(std::span<const Point<2>> line, const TakePiece& take) = 0;
  /// Cuts a polygon, its outer ring first, likewise; parts are so, too. Throws Failure for polygons
  /// that cross themselves.
  virtual void cut_polygon(const PolygonRings& polygon, const TakePart& take) = 0;
  /// Replaces `tiles` by those that a place lies in; where tiles share an edge, one of them.
  virtual void find(const Point<2>& place, std::vector<std::size_t>& tiles) = 0;
  [[nodiscard]] virtual std::string path(std::size_t tile) const = 0;
  /// Those of some tiles, in their order. Throws InvalidArgument if two are one.
  [[nodiscard]] std::vector<std::string> paths(std::span<const std::size_t> tiles) const;
  /// The files in the folder whose names could be those of other tiles, sorted.
  [[nodiscard]] virtual std::vector<std::string> others_than(
      std::vector<std::string> paths) const = 0;
  /// The coordinate system that it is in; empty: that of what is cut.
  [[nodiscard]] virtual std::string crs() const { return {}; }
};

/// Squares of a side above 0, or the polygons of a vector file, for files of a pattern; null for
/// neither. Throws InvalidArgument if the pattern does not go with that, and Failure if polygons
/// cannot be read.
std::unique_ptr<VectorTiling> make_vector_tiling(const std::string& pattern, double side,
                                                 const std::string& polygons);

}  // namespace spillway::stream
