#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <unordered_map>
#include <vector>

#include "formats/disk/scratch_folder.h"
#include "formats/points/common/point_reader.h"
#include "src/geometry/box.h"
#include "src/runtime/stage_times.h"
#include "stream/checkpoint/resting.h"
#include "stream/points/encoded_points.h"
#include "stream/points/point_feed.h"
#include "stream/tiles/cuts/cut_tree.h"
#include "stream/tiles/cuts/dealt_points.h"
#include "stream/tiles/point_batch.h"
#include "stream/tiles/regions/region_plan.h"
#include "stream/tiles/storage/segment_reader.h"
#include "stream/tiles/storage/tile.h"
#include "stream/tiles/tile_cut.h"
#include "stream/tiles/tile_node.h"
#include "stream/tiles/tile_sketches.h"
#include "stream/tiles/tile_tree_options.h"

namespace spillway::detail {

/// Points of any number and order, dealt into tiles that fit into memory. Points wait in memory;
/// when too many do, tiles write theirs to the disk. A tile that has become too large is cut in two
/// at once. Of its points those in memory are dealt to the halves, and on the disk those segments
/// go to a half that lie in it; the others are left over, to be dealt once more when all points are
/// in. So a point is written at most twice as a rule, and once where the order is that of a
/// scanner; once more by divide_evenly().
class TileTree {
 public:
  TileTree(const TileTreeOptions& options, ScratchFolder& folder, StageTimes& times);

  /// From now on it is known where the points will lie, and a sample of them is. To be called
  /// before fill().
  void expect(const Box<3>& extent, std::vector<LatticePoint> sample) {
    options_.extent = extent;
    options_.sample = std::move(sample);
  }

  /// Told how many points have been dealt again, and what share that is of all for which this is
  /// known to be necessary, from 0 to 1.
  using DivisionProgress = std::function<void(std::uint64_t points, double fraction)>;

  /// Told of a cell of the plan that is complete: take_cell() gives its tiles.
  using CellDone = std::function<void(std::uint32_t cell)>;

  /// Deals all points of `source`. Reading, decoding, dealing, encoding and writing go on beside
  /// each other; the result does not depend on threads. With a plan, `done` is called for one cell
  /// at a time, in an order that does not depend on threads either, while other threads read on.
  /// Cells that have been parted on the disk are not told of: finish() gives them.
  void fill(const PointFeed& source, const CellDone& done = {});

  /// The same with points that need no decoding: `source` works as PointReader::read().
  void fill(const std::function<bool(PointBlock&)>& source);

  /// Points that fill() has left over, and those of tiles that are too large.
  [[nodiscard]] std::uint64_t points_to_divide() const;
  /// Whether there are some, or a division was begun before state().
  [[nodiscard]] bool is_to_divide() const { return dealing_again_ || points_to_divide() > 0; }

  /// Deals those points once more, by all threads, and what is too large again of them. Returns how
  /// many points were dealt again, those dealt twice counted twice.
  std::uint64_t divide_large(const DivisionProgress& progress);

  /// Whether larger tiles can be put together of these in their order, so that few are begun and
  /// not complete at a time. So it is where tiles have been cut in halves of all points, but not
  /// where they were cut as the points came, across a flight line first.
  [[nodiscard]] bool nests() const;

  /// Divides all points anew, into tiles that nest. Leaves over what is on the disk, for
  /// divide_large(). To be called after that, before take_nodes(), and not with a plan.
  void divide_evenly();

  /// The cells of the plan that `done` was not told of, which are complete now that all is divided.
  std::vector<std::uint32_t> finish();

  /// What waits of complete tiles goes to the disk, while no other thread is at work. Returns the
  /// bytes of memory that it took.
  std::uint64_t spill_complete();

  /// From now on fill() and divide_large() come to rest when a checkpoint is due, for state() to be
  /// told. Who goes on from it calls the one of them that was under way once more, after state().
  void rest_for(const Checkpointing& checkpointing) { checkpointing_ = checkpointing; }
  template <typename State>
  void state(State& state);

  /// The balanced tree of tiles, none of which is too large any more, neighbours that fit together
  /// made one; nothing if there are no points. Of all points, once and at the end, or of those in
  /// one cell.
  template <int D>
  [[nodiscard]] std::optional<TileNode<D>> take_nodes();
  template <int D>
  [[nodiscard]] std::optional<TileNode<D>> take_cell(std::uint32_t cell);

  /// Takes a tile of take_nodes() out of the tree: reads what is on the disk of it. By one thread
  /// at a time, but beside fill() and decode().
  template <int D>
  StoredTile read(const TileNode<D>& node);

  /// Whether a part of the tile is on the disk.
  template <int D>
  [[nodiscard]] bool on_disk(const TileNode<D>& node) const;

  /// The points of a tile; equal ones in the order in which they came. Uses all threads.
  template <int D>
  TilePoints<D> decode(StoredTile stored) const;

  /// What points take that wait in memory, of tiles that have not been read. Not beside fill().
  [[nodiscard]] std::uint64_t held_bytes() const;
  /// Most points of one tile, as many points as have been dealt so far.
  [[nodiscard]] std::size_t capacity() const { return capacity_; }
  /// Points dealt so far.
  [[nodiscard]] std::uint64_t points() const { return points_; }
  /// How many points were written to the disk, those written twice counted twice.
  [[nodiscard]] std::uint64_t points_written() const { return points_written_; }
  [[nodiscard]] std::uint64_t bytes_written() const { return bytes_written_; }

 private:
  using Batch = PointBatch;
  using Fetch = std::function<bool(Batch&)>;
  using Decode = std::function<void(Batch&, PointBlock&)>;
  /// Sends batches through the steps: `fetch` fills them in order, `decode` makes their points.
  void run_batches(const Fetch& fetch, const Decode& decode, const CellDone& done);
  void run_to_rest(const Fetch& fetch, const Decode& decode, const CellDone& done);
  void deal(Batch& batch, const PointBlock& points) const;
  void append(Batch& batch);
  void append_dealt(const DealtPoints& dealt, Batch& batch);
  void append_points(std::uint32_t number, const PointsView& points, const Box<3>& box,
                     Batch& batch);
  void put(HeldPoints& held, Tile& tile, const PointsView& points, const Box<3>& box);
  [[nodiscard]] std::size_t most_room() const;
  void spill_some(Batch& batch);
  void spill(std::uint32_t number, Batch& batch);
  void encode(Batch& batch);
  void write(Batch& batch);

  void begin_region(std::size_t region, Batch& batch);
  void finish_cell(std::uint32_t cell, Batch& batch);
  [[nodiscard]] bool left_over_below(CutTree::NodeRef ref) const;
  [[nodiscard]] double spill_weight(const Tile& tile) const;
  [[nodiscard]] bool stays_whole();
  void divide_first(Batch& batch);
  void divide(std::uint32_t number, std::vector<LatticePoint> sample, std::size_t tile_count,
              Batch& batch, bool representative = true);
  void judge_tiles(std::span<const LatticePoint> sample);
  void deal_held(HeldPoints held, Batch& batch);
  [[nodiscard]] RegionPlan plan_anew(double most_points) const;
  [[nodiscard]] bool outgrown(const Tile& tile) const;
  [[nodiscard]] bool too_large(const Tile& tile) const;
  [[nodiscard]] bool will_be_too_large(const Tile& tile) const;
  [[nodiscard]] bool is_too_long(std::uint32_t number) const;
  void cut_long();
  void cut_long_below(CutTree::NodeRef ref);
  [[nodiscard]] bool to_be_cut(std::uint32_t number, bool complete) const;
  void cut_in_two(std::uint32_t number, bool complete);
  void deal_to_halves(HeldPoints held, const TileCut& cut,
                      const std::array<std::uint32_t, 2>& halves);
  void set_cell_root(std::uint32_t tile, std::uint32_t cell, CutTree::NodeRef cut);
  void leave_over(CutTree::NodeRef cut, TileSegment segment);
  [[nodiscard]] std::vector<TileSegment> take_left_over();
  void append_left_over(CutTree::NodeRef ref, std::vector<TileSegment>& segments);
  [[nodiscard]] std::size_t sample_stride() const;
  void append_segments_of(HeldPoints held, std::vector<HeldPoints>& segments) const;
  void deal_again(const std::function<void(std::uint64_t points)>& progress);

  template <int D>
  struct Joinable;
  template <int D>
  Joinable<D> join_below(CutTree::NodeRef ref, std::vector<TileNode<D>>& tiles) const;
  template <int D>
  [[nodiscard]] std::optional<TileNode<D>> nodes_below(CutTree::NodeRef ref) const;
  [[nodiscard]] std::uint64_t points_to_come() const;
  void take_below(CutTree::NodeRef ref);
  [[nodiscard]] Tile take(std::uint32_t number);

  TileTreeOptions options_;
  ScratchFolder& folder_;
  StageTimes& times_;
  TileSketches sketches_;
  CutTree cuts_;
  std::uint64_t cuts_made_ = 0;
  mutable std::shared_mutex cuts_mutex_;  ///< guards both: batches are dealt meanwhile
  std::vector<Tile> tiles_;
  std::vector<CutTree::NodeRef> cell_roots_;         ///< by cell of the plan
  std::vector<bool> cell_done_;                      ///< likewise
  std::size_t regions_begun_ = 0;                    ///< of the plan
  mutable std::mutex taken_mutex_;                   ///< guards the next one
  std::unordered_map<std::uint32_t, Tile> taken_;    ///< complete, by their number
  std::vector<std::vector<TileSegment>> left_over_;  ///< by cut
  std::uint64_t left_over_points_ = 0;
  std::optional<SegmentReader> dealing_again_;  ///< what is being dealt once more
  std::uint64_t dealt_again_ = 0;               ///< points, before these
  std::mutex stretches_mutex_;  ///< guards what is known of stretches, which are written meanwhile
  std::uint64_t batches_ = 0;
  std::uint64_t arrivals_ = 0;  ///< handed out so far
  std::uint64_t runs_ = 0;      ///< likewise
  std::size_t capacity_ = 0;
  std::atomic<std::uint64_t> points_ = 0;
  std::size_t room_ = 0;      ///< that all tiles' buffers take, in points
  std::size_t segments_ = 0;  ///< of all tiles, and those left over
  std::uint64_t points_written_ = 0;
  std::uint64_t bytes_written_ = 0;
  bool divided_ = false;  ///< the first division has been made
  bool filled_ = false;
  Checkpointing checkpointing_;
};

}  // namespace spillway::detail
