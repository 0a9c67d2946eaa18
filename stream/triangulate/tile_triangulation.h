#pragma once

#include <spillway/triangulate.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <span>
#include <vector>

#include "src/delaunay/common/schedule.h"
#include "src/delaunay/division/divide.h"
#include "src/runtime/memory_budget.h"
#include "src/runtime/stage_times.h"
#include "stream/output/heights.h"
#include "stream/output/sequencer.h"
#include "stream/output/stream_place.h"
#include "stream/tiles/storage/tile_points.h"
#include "stream/tiles/tile_node.h"
#include "stream/triangulate/border.h"
#include "stream/triangulate/settle.h"
#include "stream/triangulate/surroundings.h"

namespace spillway::stream {

/// Sets `most` to `now` if that is more; for any thread.
template <typename Number>
void raise(std::atomic<Number>& most, Number now) {
  Number seen = most;
  while (seen < now && !most.compare_exchange_weak(seen, now)) {
  }
}

/// How much of borders is in memory, and the most there was. It grows with the input: the budget
/// refuses what outgrows it.
class ResidentBorders {
 public:
  explicit ResidentBorders(MemoryBudget& budget) : budget_(budget) {}
  ~ResidentBorders() { budget_.give_back(bytes_); }
  ResidentBorders(const ResidentBorders&) = delete;
  ResidentBorders& operator=(const ResidentBorders&) = delete;

  void add(std::uint64_t simplices, std::uint64_t bytes) {
    budget_.take(bytes, "the border between tiles");
    raise(most_simplices_, simplices_ += simplices);
    raise(most_bytes_, bytes_ += bytes);
  }
  void remove(std::uint64_t simplices, std::uint64_t bytes) {
    simplices_ -= simplices;
    bytes_ -= bytes;
    budget_.give_back(bytes);
  }
  /// Of what is in memory add() tells.
  template <typename State>
  void state(State& state) {
    state(most_simplices_, most_bytes_);
  }
  [[nodiscard]] std::uint64_t most_simplices() const { return most_simplices_; }
  [[nodiscard]] std::uint64_t most_bytes() const { return most_bytes_; }

 private:
  MemoryBudget& budget_;
  std::atomic<std::uint64_t> simplices_ = 0;
  std::atomic<std::uint64_t> bytes_ = 0;
  std::atomic<std::uint64_t> most_simplices_ = 0;
  std::atomic<std::uint64_t> most_bytes_ = 0;
};

/// What is counted on the way, by many threads.
struct StreamCounts {
  explicit StreamCounts(MemoryBudget& budget) : borders(budget) {}

  StageTimes times;
  ResidentBorders borders;
  std::atomic<std::uint64_t> points = 0;  ///< that have been through a leaf
  std::atomic<std::uint64_t> duplicates = 0;
  std::atomic<std::uint64_t> hull_facets = 0;
  std::atomic<std::uint64_t> left_out = 0;
  std::atomic<std::uint64_t> final_in_leaves = 0;  ///< simplices, infinite ones included
  std::atomic<std::uint64_t> final_in_tiles = 0;   ///< in merges inside tiles
  std::atomic<std::uint64_t> leaves = 0;
  std::atomic<std::uint64_t> densest_leaf = 0;    ///< simplices for each of its points, rounded up
  std::atomic<std::uint64_t> retriangulated = 0;  ///< points in triangulations of borders

  void add(const TorusProof& proof) {
    const std::lock_guard lock(torus_mutex_);
    torus_.add(proof);
  }
  /// Once nobody adds to it.
  [[nodiscard]] const TorusProof& torus() const { return torus_; }

  template <typename State>
  void state(State& state) {
    state(borders, points, duplicates, hull_facets, left_out, final_in_leaves, final_in_tiles,
          leaves, densest_leaf, retriangulated, torus_);
  }

 private:
  std::mutex torus_mutex_;
  TorusProof torus_;  ///< in a periodic domain
};

/// What all tiles and merges of a run share; used by many threads at once.
template <int D>
struct TileContext {
  const TriangulateOptions& asked;
  OutputOptions output;
  std::size_t leaf_points = 0;  ///< most of a leaf
  MemoryBudget& budget;         ///< for the triangulations of borders
  Sequencer<D>& sequencer;      ///< takes what is final
  StreamCounts& counts;
  std::function<void()> progress;  ///< called after each leaf, by any thread
};

/// A loaded tile.
template <int D>
struct TileInput {
  TilePoints<D> points;
  const Outside<D>& outside;
  std::uint32_t slot = 0;  ///< of the stream
};

/// A node of the tree over tiles whose children are done.
template <int D>
struct MergeInput {
  std::span<Border<D>> children;  ///< which are used up
  const TileNode<D>& node;
  const Outside<D>& outside;
  BlockPlace place;  ///< of the stream
  /// Whether boxes outside are tighter now than when the children were settled: then what they have
  /// kept may be final, though no sibling touches it.
  bool outside_shrank = false;
};

/// What a merge leaves.
template <int D>
struct MergedTiles {
  Border<D> border;
  std::uint64_t final_simplices = 0;
};

/// Most points of a leaf, or of a tile, that is larger than others since no cut of it pays, where
/// memory is limited to so many bytes. Points carry attributes of `record_size` bytes.
template <int D>
std::size_t largest_undivided(std::uint64_t limit, std::size_t record_size);

/// Triangulates a loaded tile: divides it into leaves, works them off in order by all threads, and
/// merges what is left of them; everything that is final goes to the sequencer, as the blocks of
/// the tile's slot. Returns what is not final.
template <int D>
Border<D> triangulate_tile(const TileContext<D>& context, TileInput<D> tile, Task& task);

/// Merges the borders of a node of the tree over tiles; what is final now goes to the sequencer, as
/// the one block of the node's slot.
template <int D>
MergedTiles<D> merge_tiles(const TileContext<D>& context, const MergeInput<D>& input, Task& task);

}  // namespace spillway::stream
