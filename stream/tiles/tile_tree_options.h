#pragma once

#include <spillway/choices.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "src/geometry/box.h"
#include "src/geometry/framed_point.h"
#include "stream/points/points_view.h"
#include "stream/tiles/regions/region_plan.h"

namespace spillway::stream {

/// How a TileTree deals its points.
struct TileTreeOptions {
  int dimension = 2;
  std::size_t capacity = 0;                 ///< most points of one tile, equal points apart
  std::size_t buffered_points = 0;          ///< most points waiting in memory
  std::optional<std::uint64_t> expected{};  ///< how many points will come, where that is known
  std::optional<Box<3>> extent{};           ///< where they will lie, where that is known
  std::vector<LatticePoint> sample{};       ///< of the points to come, where there is one
  bool index = false;                       ///< points keep their index; that of others is dropped
  std::size_t record_size = 0;              ///< bytes of the attributes that points carry
  std::uint64_t sketch_bytes = 0;           ///< that sketches of tiles may take, about
  std::size_t batches = 6;                  ///< most of them under way at a time
  const RegionPlan* plan = nullptr;         ///< that the feed keeps to; outlives the tree
  /// So many points in memory may be one tile, though that is more than its capacity, if no cut of
  /// them pays.
  std::size_t largest_undivided = 0;
  /// If set, loading makes one point of a tile of points that are one vertex, where they are more
  /// than a tile may have: which one, in the plane, this tells.
  std::optional<Heights> one_of_equal{};
  /// Told of all points of such a tile.
  std::function<void(const PointsView&)> tell_equal{};
};

}  // namespace spillway::stream
