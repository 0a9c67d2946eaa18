#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <shared_mutex>
#include <vector>

#include "stream/points/points_view.h"
#include "stream/tiles/cuts/cut_tree.h"
#include "stream/tiles/storage/tile.h"
#include "stream/tiles/tile_tree_options.h"

namespace spillway::stream {

/// The tiles that points are dealt into, and what is known of all of them: what those who deal,
/// spill, divide and load share. For the one thread that deals, but for what says otherwise; it
/// alone writes the cuts, and reads them without their mutex.
struct TileTable {
  explicit TileTable(const TileTreeOptions& of);

  /// All points, as far as is known.
  [[nodiscard]] std::uint64_t points_to_come() const;
  /// Points that may wait, besides the room that is taken by what is known of tiles.
  [[nodiscard]] std::size_t most_room() const;
  /// Of samples by which many tiles are made at once.
  [[nodiscard]] std::size_t sample_stride() const;

  /// Puts points of that box into a buffer of a tile.
  void put(HeldPoints& held, Tile& tile, const PointsView& some, const Box<3>& box);

  /// A tile has been cut: if it was a whole cell of the plan, that is now what is below the cut.
  void set_cell_root(std::uint32_t tile, std::uint32_t cell, CutTree::NodeRef cut);

  template <typename State>
  void state(State& state) {
    state(options.extent, options.sample);  // as TileTree::expect() has told
    state(cuts, cuts_made, tiles, cell_roots, regions_begun, batches, runs, capacity, points,
          segments, divided, filled);
    if constexpr (State::kReads) {
      room = 0;
      for (const Tile& tile : tiles) room += tile.room();
    }
  }

  TileTreeOptions options;
  CutTree cuts;
  std::uint64_t cuts_made = 0;
  mutable std::shared_mutex cuts_mutex;  ///< guards both: batches are dealt meanwhile
  std::vector<Tile> tiles;
  std::vector<CutTree::NodeRef> cell_roots;  ///< by cell of the plan
  std::size_t regions_begun = 0;             ///< of the plan
  /// Guards what is known of stretches, which are written meanwhile.
  std::mutex stretches_mutex;
  std::uint64_t batches = 0;  ///< that have come
  std::uint64_t runs = 0;     ///< handed out so far
  /// Most points of one tile, as many points as have come so far. With a plan it stays as it is, so
  /// that other threads may read it.
  std::size_t capacity = 0;
  std::atomic<std::uint64_t> points = 0;  ///< that have come
  std::size_t room = 0;                   ///< that all tiles' buffers take, in points
  std::size_t segments = 0;               ///< of all tiles, and those left over
  bool divided = false;                   ///< the first division has been made
  bool filled = false;                    ///< all points have come
};

}  // namespace spillway::stream
