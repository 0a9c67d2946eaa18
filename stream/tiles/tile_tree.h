#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "formats/disk/scratch_folder.h"
#include "src/geometry/box.h"
#include "src/runtime/stage_times.h"
#include "stream/points/point_feed.h"
#include "stream/tiles/dealing_watch.h"
#include "stream/tiles/even_tiles.h"
#include "stream/tiles/point_batch.h"
#include "stream/tiles/storage/segment_reader.h"
#include "stream/tiles/storage/tile.h"
#include "stream/tiles/storage/tile_points.h"
#include "stream/tiles/tile_dealer.h"
#include "stream/tiles/tile_divider.h"
#include "stream/tiles/tile_loader.h"
#include "stream/tiles/tile_node.h"
#include "stream/tiles/tile_sketches.h"
#include "stream/tiles/tile_spiller.h"
#include "stream/tiles/tile_table.h"
#include "stream/tiles/tile_tree_options.h"

namespace spillway::stream {

/// Points of any number and order, dealt into tiles that fit into memory. Points wait in memory;
/// when too many do, tiles write theirs to the disk. A tile that has become too large is cut in two
/// at once. Of its points those in memory are dealt to the halves, and on the disk those segments
/// go to a half that lie in it; the others are left over, to be dealt once more when all points are
/// in. So a point is written at most twice as a rule, and once where the order is that of a
/// scanner; once more by divide_evenly().
///
/// This is the order of the steps. A TileDealer deals the points, a TileSpiller brings them to the
/// disk, a TileDivider cuts tiles, and a TileLoader loads them.
class TileTree {
 public:
  /// All but the options must outlive it.
  TileTree(const TileTreeOptions& options, ScratchFolder& folder, StageTimes& times,
           DealingWatch& watch);

  /// From now on it is known where the points will lie, and a sample of them is. To be called
  /// before fill().
  void expect(const Box<3>& extent, std::vector<LatticePoint> sample) {
    table_.options.extent = extent;
    table_.options.sample = std::move(sample);
  }

  /// Deals all points of `source`. Reading, decoding, dealing, encoding and writing go on beside
  /// each other; the result does not depend on threads. With a plan, the watch is told of cells as
  /// they are complete, but for those that have been parted on the disk: finish() gives them.
  void fill(PointFeed& source);

  /// The same with points that need no decoding: `source` works as PointReader::read().
  void fill(const std::function<bool(PointBlock&)>& source);

  /// Points that fill() has left over, and those of tiles that are too large.
  [[nodiscard]] std::uint64_t points_to_divide() const { return divider_.points_to_divide(); }
  /// Whether there are some, or a division was begun before state().
  [[nodiscard]] bool is_to_divide() const { return dealing_again_ || points_to_divide() > 0; }

  /// Deals those points once more, by all threads, and what is too large again of them. Returns how
  /// many points were dealt again, those dealt twice counted twice.
  std::uint64_t divide_large();

  /// Whether larger tiles can be put together of these in their order (tiles_nest()).
  [[nodiscard]] bool nests() const { return points() == 0 || tiles_nest(table_); }

  /// Divides all points anew, into tiles that nest. Leaves over what is on the disk, for
  /// divide_large(). To be called after that, before take_nodes(), and not with a plan.
  void divide_evenly();

  /// The cells of the plan that the watch was not told of, which are complete now that all is
  /// divided.
  std::vector<std::uint32_t> finish();

  /// What waits of complete tiles goes to the disk, while no other thread is at work. Returns the
  /// bytes of memory that it took.
  std::uint64_t spill_complete() { return spiller_.spill_complete(loader_.waiting()); }

  /// For fill() and divide_large(), which come to rest when the watch wants it. Who goes on calls
  /// the one of them that was under way once more, after this.
  template <typename State>
  void state(State& state) {
    state.section("tiles");
    state(sketches_, table_, spiller_, divider_, loader_, cell_done_, dealing_again_, dealt_again_);
  }

  /// The balanced tree of tiles, none of which is too large any more, neighbours that fit together
  /// made one; nothing if there are no points. Of all points, once and at the end, or of those in
  /// one cell. Along axes beyond z they have the extent of `all`.
  template <int D>
  [[nodiscard]] std::optional<TileNode<D>> take_nodes(const Box<D>& all = {});
  template <int D>
  [[nodiscard]] std::optional<TileNode<D>> take_cell(std::uint32_t cell) const {
    return loader_.nodes_below<D>(table_.cell_roots[cell], {});
  }

  /// Its tiles, for who reads them. Beside fill(), too.
  [[nodiscard]] TileLoader& loader() { return loader_; }

  /// What points take that wait in memory, of tiles that have not been read. Not beside fill().
  [[nodiscard]] std::uint64_t held_bytes() const;
  /// Most points of one tile, as many points as have been dealt so far.
  [[nodiscard]] std::size_t capacity() const { return table_.capacity; }
  /// Points dealt so far.
  [[nodiscard]] std::uint64_t points() const { return table_.points; }
  /// How many points were written to the disk, those written twice counted twice.
  [[nodiscard]] std::uint64_t points_written() const { return spiller_.points_written(); }
  [[nodiscard]] std::uint64_t bytes_written() const { return spiller_.bytes_written(); }

 private:
  class FeedSteps;
  class StoredSteps;
  template <typename Steps>
  [[nodiscard]] bool run_batches(Steps& steps);
  template <typename Steps>
  void run_to_rest(Steps steps);
  void append(PointBatch& batch);
  void begin_region(std::size_t region, PointBatch& batch);
  void finish_cell(std::uint32_t cell, PointBatch& batch);
  void begin_dealing_again();
  void deal_waiting(std::vector<HeldPoints> held);
  void spill(PointBatch& batch);

  StageTimes& times_;
  DealingWatch& watch_;
  TileTable table_;
  TileSketches sketches_;
  TileSpiller spiller_;
  TileDivider divider_;
  TileDealer dealer_;
  TileLoader loader_;
  std::vector<bool> cell_done_;                 ///< by cell of the plan
  std::optional<SegmentReader> dealing_again_;  ///< what is being dealt once more
  std::uint64_t dealt_again_ = 0;               ///< points, before these
};

}  // namespace spillway::stream
