#pragma once

#include <cstdint>
#include <mutex>
#include <optional>
#include <unordered_map>
#include <vector>

#include "src/runtime/stage_times.h"
#include "stream/tiles/cuts/cut_tree.h"
#include "stream/tiles/storage/tile.h"
#include "stream/tiles/storage/tile_points.h"
#include "stream/tiles/tile_node.h"
#include "stream/tiles/tile_sketches.h"
#include "stream/tiles/tile_table.h"

namespace spillway::stream {

/// The tiles that get no more points: the tree over them, and their points when they are loaded.
class TileLoader {
 public:
  /// All must outlive it.
  TileLoader(TileTable& table, const TileSketches& sketches, StageTimes& times)
      : table_(table), sketches_(sketches), times_(times) {}

  /// Takes the tiles below a node out of the table. What is known of their segments waits until
  /// they are read, so it is made short.
  void take_below(CutTree::NodeRef ref);

  /// The balanced tree of those that have been taken below a node, neighbours that fit together
  /// made one; nothing if they have no points. Along axes beyond z, on which none is cut, they have
  /// the extent of `all`. By any thread.
  template <int D>
  [[nodiscard]] std::optional<TileNode<D>> nodes_below(CutTree::NodeRef ref,
                                                       const Box<D>& all) const;

  /// Lets go of a tile and reads what is on the disk of it. By one thread at a time, but beside all
  /// others.
  template <int D>
  StoredTile read(const TileNode<D>& node);

  /// Whether a part of the tile is on the disk.
  template <int D>
  [[nodiscard]] bool on_disk(const TileNode<D>& node) const;

  /// The points of a tile; equal ones in the order in which they came. Uses all threads.
  template <int D>
  TilePoints<D> decode(StoredTile stored) const;

  /// What points take that wait in memory.
  [[nodiscard]] std::uint64_t held_bytes() const;

  /// All that have been taken and not been read. For it and state() no other thread is at work, so
  /// that they need no lock.
  [[nodiscard]] std::vector<Tile*> waiting();

  /// Writes or reads all of them.
  template <typename State>
  void state(State& state);

 private:
  template <int D>
  struct Joinable;
  template <int D>
  Joinable<D> join_below(CutTree::NodeRef ref, const Box<D>& all,
                         std::vector<TileNode<D>>& tiles) const;
  template <int D>
  void sketch(std::vector<TileNode<D>>& tiles) const;
  [[nodiscard]] Tile take(std::uint32_t number);

  TileTable& table_;
  const TileSketches& sketches_;
  StageTimes& times_;
  mutable std::mutex taken_mutex_;                 ///< guards the next one
  std::unordered_map<std::uint32_t, Tile> taken_;  ///< by their number
};

}  // namespace spillway::stream
