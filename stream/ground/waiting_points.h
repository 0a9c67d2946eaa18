#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "formats/disk/scratch_folder.h"
#include "src/geometry/framed_point.h"
#include "src/runtime/stage_times.h"
#include "src/terrain/unlocated_points.h"
#include "stream/ground/ground_heights.h"
#include "stream/ground/shared_scratch.h"
#include "stream/ground/tile_index.h"
#include "stream/plan/memory_plan.h"
#include "stream/tiles/tile_tree.h"

namespace spillway::stream {

struct WaitingPointsOptions {
  std::uint64_t memory = 0;  ///< to keep to, in bytes: 32 MiB at least
  std::uint64_t whole = 0;   ///< memory that it is a part of, for messages
  unsigned threads = 1;
  std::optional<std::uint64_t> expected{};  ///< how many points will come, where that is known
  std::optional<Box<3>> extent{};           ///< where they will lie, likewise
};

/// Points of any number that wait for the triangles below them, which come in any order: a join of
/// both by tiles (after J. Patel, D. DeWitt, "Partition based spatial-merge join", SIGMOD 1996).
/// Points are dealt into tiles first. A triangle waits at each tile that it may have points of.
/// When so many have come that it pays, the tile's points are loaded, and those that are located
/// are done; the others wait on. So most points are loaded once, with the triangles that come
/// together, and only those at the borders of what was triangulated together more often. Triangles
/// that wait in vain go to the disk when memory is short.
class WaitingPoints {
 public:
  /// `scratch` must outlive it. Throws TooSmallLimit for less memory than that.
  WaitingPoints(const WaitingPointsOptions& options, ScratchFolder& scratch);
  ~WaitingPoints();

  /// Takes all points, x and y in the coordinates of the triangles, with their numbers as index,
  /// which are below what `numbers` tells afterwards.
  void deal(PointFeed& points, const std::function<std::uint64_t()>& numbers);

  /// Takes triangles, three places in `vertices` each. By any number of threads at once.
  void add(std::span<const PlacedPoint> vertices, std::span<const std::uint32_t> corners);

  /// After the last triangle: locates what is left, by all threads. `progress` is told how many
  /// points were looked at.
  void finish(const std::function<void(std::uint64_t points)>& progress);

  /// What was found. After finish(), once.
  [[nodiscard]] std::unique_ptr<GroundHeights> take_heights() { return std::move(heights_); }
  [[nodiscard]] std::uint64_t points() const { return tree_->points(); }
  [[nodiscard]] std::uint64_t located() const { return located_; }
  [[nodiscard]] std::uint64_t spilled_bytes() const;

 private:
  struct Tile;
  struct Block;
  struct Workspace;

  void add_coherent(const Block& block, std::span<const std::uint32_t> tiles);
  void add_scattered(const Block& block);
  void wait_at(Tile& tile, const Block& block, std::span<const std::uint32_t> numbers);
  void locate(Tile& tile, const Block& block, std::span<const std::uint32_t> numbers);
  void visit_places(Tile& tile, Workspace& work, const std::function<void()>& visit);
  void keep_rest(Tile& tile, std::span<const NumberedPlace> rest);
  void relieve();
  [[nodiscard]] std::unique_ptr<Workspace> take_workspace();
  void give_back(std::unique_ptr<Workspace> workspace);

  const std::uint64_t memory_;
  const MemoryPlan plan_;
  const std::size_t tile_points_;  ///< most of a tile; of equal ones so many are located at a time
  ScratchFolder& scratch_;
  StageTimes times_;
  DealingWatch watch_;
  std::optional<TileTree> tree_;
  std::optional<TileNode<2>> root_;
  TileIndex index_;
  std::unique_ptr<Tile[]> tiles_;
  std::unique_ptr<GroundHeights> heights_;
  SharedScratch spilled_;
  std::mutex loader_mutex_;
  std::mutex relief_mutex_;
  std::mutex workspaces_mutex_;
  std::vector<std::unique_ptr<Workspace>> workspaces_;  ///< not in use; guarded by its mutex
  std::atomic<std::uint64_t> located_ = 0;
  std::atomic<std::uint64_t> triangle_bytes_ = 0;  ///< of triangles that wait in memory
  std::atomic<std::uint64_t> rest_bytes_ = 0;      ///< of points in memory that were loaded before
};

}  // namespace spillway::stream
