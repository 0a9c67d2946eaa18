#pragma once

#include <spillway/clip.h>

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "stream/library/points/clip_polygons.h"
#include "stream/library/tiling/mesh_tiling.h"

namespace spillway::stream {

/// The one file of what is left of a mesh that is clipped.
class ClippedMesh final : public MeshTiling {
 public:
  /// Throws as read_clip().
  ClippedMesh(std::string path, const Clip& clip)
      : ClippedMesh(std::move(path), read_clip(clip), clip.outside) {}

  void find(const Point<2>& place, std::vector<std::size_t>& tiles) override {
    tiles.assign(area_.keeps(place) ? 1 : 0, 0);
  }
  [[nodiscard]] std::string path(std::size_t /*tile*/) const override { return path_; }
  [[nodiscard]] std::vector<std::string> others_than(
      std::vector<std::string> /*paths*/) const override {
    return {};
  }
  [[nodiscard]] std::string crs() const override { return crs_; }

 private:
  ClippedMesh(std::string path, const PolygonLayer& layer, bool outside)
      : path_(std::move(path)), area_(clip_area(layer, outside)), crs_(layer.crs) {}

  std::string path_;
  ClipArea area_;
  std::string crs_;
};

}  // namespace spillway::stream
