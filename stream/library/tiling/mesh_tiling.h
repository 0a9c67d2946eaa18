#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "src/geometry/point.h"

namespace spillway::stream {

/// How simplices are dealt into files. Tiles have numbers from 0 on.
class MeshTiling {
 public:
  MeshTiling() = default;
  virtual ~MeshTiling() = default;
  MeshTiling(const MeshTiling&) = delete;
  MeshTiling& operator=(const MeshTiling&) = delete;

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

}  // namespace spillway::stream
