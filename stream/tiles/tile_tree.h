#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "formats/disk/scratch_folder.h"
#include "formats/points/common/point_reader.h"
#include "src/geometry/box.h"
#include "src/runtime/stage_times.h"
#include "stream/tiles/cut_tree.h"
#include "stream/tiles/dealt_points.h"
#include "stream/tiles/point_buffer.h"
#include "stream/tiles/point_feed.h"
#include "stream/tiles/tile_block.h"

namespace spillway::detail {

struct TileTreeOptions {
  int dimension = 2;
  std::size_t capacity = 0;                 ///< most points of one tile, equal points apart
  std::size_t buffered_points = 0;          ///< most points waiting in memory
  std::optional<std::uint64_t> expected{};  ///< how many points will come, where that is known
  std::optional<Box<3>> extent{};           ///< where they will lie, where that is known
  bool index = false;                       ///< points keep their index; that of others is dropped
};

/// A node of the finished tree over tiles: a tile that can be loaded, or two nodes.
template <int D>
struct TileNode {
  Box<D> box;  ///< tight around its points
  std::uint64_t points = 0;
  std::vector<TileNode> children;     ///< none for a tile
  std::vector<std::uint32_t> stored;  ///< of a tile: the stored tiles it is made of

  [[nodiscard]] std::uint64_t size() const { return points; }
  [[nodiscard]] bool leaf() const { return children.empty(); }
};

/// A tile's points as they lay in the tree: on the disk, encoded, and in memory.
struct StoredTile {
  struct Segment {
    std::vector<std::byte> bytes;
    std::vector<TileBlock> blocks;
    std::string file;  ///< its name, for messages
    PointBuffer buffer;
  };
  std::vector<Segment> segments;
  std::uint64_t points = 0;
};

/// Points of any number, dealt into tiles that fit into memory. Points wait in memory; when too
/// many do, the tiles with most of them write theirs to the disk. The first division is made when
/// that happens for the first time, of what is known then: the points so far, and the expected
/// number and extent. When all points are in, tiles that became too large are divided once more,
/// their number then being known, so a point is written at most twice as a rule.
class TileTree {
 public:
  TileTree(const TileTreeOptions& options, ScratchFolder& folder, StageTimes& times);

  /// Told how many points have been dealt again, and what share that is of all for which this is
  /// known to be necessary, from 0 to 1.
  using DivisionProgress = std::function<void(std::uint64_t points, double fraction)>;

  /// Deals all points of `source`. Reading, decoding, dealing, encoding and writing go on beside
  /// each other; the result does not depend on threads.
  void fill(const PointFeed& source);

  /// The same with points that need no decoding: `source` works as PointReader::read().
  void fill(const std::function<bool(PointBlock&)>& source);

  /// Points of the tiles that fill() has left too large.
  [[nodiscard]] std::uint64_t points_to_divide() const;

  /// Divides those tiles, and what is too large again of them. Returns how many points were
  /// dealt again, those dealt twice counted twice.
  std::uint64_t divide_large(const DivisionProgress& progress);

  /// The tree of tiles, none of which is too large any more, neighbours that fit together made one;
  /// nothing if there are no points.
  template <int D>
  [[nodiscard]] std::optional<TileNode<D>> nodes() const;

  /// Takes a tile of nodes() out of the tree: reads what is on the disk of it. By one thread at a
  /// time, but beside decode().
  template <int D>
  StoredTile read(const TileNode<D>& node);

  /// The points of a tile. Uses all threads.
  template <int D>
  TilePoints<D> decode(StoredTile stored) const;

  [[nodiscard]] std::uint64_t points() const { return points_; }
  /// How many points were written to the disk, those written twice counted twice.
  [[nodiscard]] std::uint64_t points_written() const { return points_written_; }
  [[nodiscard]] std::uint64_t bytes_written() const { return bytes_written_; }

 private:
  /// Points on their way from one tile's buffer to its file.
  struct Spill {
    std::uint32_t tile = 0;
    PointBuffer points;
    std::vector<std::byte> bytes;
    std::vector<TileBlock> blocks;
  };
  /// What goes through the pipeline at a time.
  struct Batch {
    PointBlock points;
    SourcePiece piece;                        ///< as it came from the source
    std::vector<std::byte> stored;            ///< the points as read back from a file
    FileSpot where;                           ///< in which file
    std::shared_ptr<const CutTree> dealt_by;  ///< the cuts that `dealt` comes from
    DealtPoints dealt;
    std::vector<Spill> spills;
  };
  struct Tile {
    Box<3> box;
    std::uint64_t points = 0;
    PointBuffer buffer;  ///< what came after what is in the file
    std::unique_ptr<ScratchFile> file;
    std::vector<TileBlock> blocks;
    std::vector<LatticePoint> sample;
    std::uint64_t next_sample = 0;
  };

  /// Sends batches through the steps: `fetch` fills them in order, `decode` makes their points.
  void run_batches(const std::function<bool(Batch&)>& fetch,
                   const std::function<void(Batch&)>& decode);
  void deal(Batch& batch) const;
  void append(Batch& batch);
  void append_runs(Batch& batch);
  void spill_fullest(Batch& batch);
  void write(Batch& batch);

  void divide_first();
  [[nodiscard]] bool sample_is_representative() const;
  void add_expected_points(std::vector<LatticePoint>& sample) const;
  void divide(std::uint32_t number, const std::function<void(std::uint64_t points)>& progress);
  void split(CutTree& cuts, std::uint32_t number, std::vector<LatticePoint> sample,
             std::size_t tile_count) const;
  void deal_from_memory(PointBuffer points);
  [[nodiscard]] bool too_large(const Tile& tile) const;

  template <int D>
  std::optional<TileNode<D>> node_at(CutTree::NodeRef ref) const;

  TileTreeOptions options_;
  ScratchFolder& folder_;
  StageTimes& times_;
  /// Replaced as a whole, under the mutex, since batches are dealt by it meanwhile.
  std::shared_ptr<const CutTree> cuts_;
  mutable std::mutex cuts_mutex_;
  std::vector<Tile> tiles_;
  std::uint64_t points_ = 0;
  std::size_t buffered_ = 0;  ///< room that all tiles' buffers take, in points
  std::uint64_t points_written_ = 0;
  std::uint64_t bytes_written_ = 0;
  std::size_t sample_stride_ = 1;
  bool divided_ = false;
};

}  // namespace spillway::detail
