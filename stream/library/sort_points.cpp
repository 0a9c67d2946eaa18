#include "stream/library/sort_points.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "src/parallel/parallel.h"
#include "stream/library/context/context_state.h"
#include "stream/plan/memory_plan.h"
#include "stream/source/joined_inputs.h"
#include "stream/tiles/regions/region_plan.h"
#include "stream/tiles/storage/stored_points.h"
#include "stream/tiles/tile_tree.h"

namespace spillway::stream {
namespace {

/// The usual number of points of a cell: one block of the file.
constexpr std::uint64_t kCellPoints = 65536;
/// Each cell should have room for so many points that wait, so that few are spilled at a time.
constexpr std::size_t kLeastBuffer = 512;
/// Bytes of a point on its way from its cell to the file: encoded, and decoded.
constexpr std::size_t kPointBytes = 56;
/// How often its attributes are there then: encoded, decoded, and in the block that is written.
constexpr std::size_t kRecords = 3;
/// Share of the memory for those.
constexpr double kWrittenShare = 0.4;
constexpr std::size_t kMostUnderWay = 6;

/// Points that wait in memory: fewer than where tiles are triangulated, as what a batch spills
/// counts, too, while it is written.
std::size_t buffered_points(const MemoryPlan& plan) { return plan.buffered_points / 2; }

/// The most points of a cell: what is wanted, unless that is more cells than there is memory for,
/// or more points than can be loaded.
std::size_t cell_capacity(const SortOptions& options, const MemoryPlan& plan,
                          std::optional<std::uint64_t> expected) {
  const std::uint64_t most_cells = std::max<std::uint64_t>(1, buffered_points(plan) / kLeastBuffer);
  const std::uint64_t least = expected.value_or(0) / most_cells;
  const std::uint64_t wanted =
      std::max(options.cell_points == 0 ? kCellPoints : options.cell_points, least);
  return static_cast<std::size_t>(std::min<std::uint64_t>(wanted, plan.tile_room));
}

void append_leaves(const TileNode<3>& node, std::vector<const TileNode<3>*>& leaves) {
  if (node.leaf()) leaves.push_back(&node);
  for (const TileNode<3>& side : node.children) append_leaves(side, leaves);
}

/// The tiles below a node in such an order that whoever reads them, and makes larger ones of them,
/// gets each in one stretch.
std::vector<const TileNode<3>*> cells_in_order(const TileNode<3>& root, int dimension) {
  std::vector<const TileNode<3>*> leaves;
  append_leaves(root, leaves);
  std::vector<InputRegion> regions;
  regions.reserve(leaves.size());
  for (const TileNode<3>* const leaf : leaves) regions.push_back({0, leaf->box, leaf->points});
  std::vector<const TileNode<3>*> cells;
  for (const std::size_t r : nested_order(regions, dimension)) cells.push_back(leaves[r]);
  return cells;
}

/// About where the points will lie, where that is known.
std::optional<Box<3>> extent_of(const RunPoints& points, const PointFile& file) {
  if (!points.extent || !file.decided()) return std::nullopt;
  return file.placed(*points.extent);
}

/// Points as the file will have them.
class PlacedPoints final : public PointFeed {
 public:
  PlacedPoints(PointStream& points, PointFile& file, RunWatch& watch)
      : points_(points), file_(file), watch_(watch) {}

  bool fetch(SourcePiece& piece) override {
    watch_.tell(points_.points_read(), points_.fraction_read());
    return points_.fetch(piece);
  }
  void decode(SourcePiece& piece, PointBlock& block) override {
    points_.decode(piece, block);
    file_.place(block);
  }

 private:
  PointStream& points_;
  PointFile& file_;
  RunWatch& watch_;
};

class Sorting : private DealingWatch {
 public:
  Sorting(const RunPoints& points, PointFile& file, const Context& context, RunWatch& watch)
      : points_(*points.stream),
        files_(points.files),
        file_(file),
        watch_(watch),
        memory_(context.memory()),
        record_size_(points.attributes.record_size()),
        plan_(plan_memory(memory_, 2, context.threads(), 0, false, record_size_)),
        capacity_(cell_capacity(*file.sorted(), plan_, points_.expected())),
        scratch_(context.state().scratch(context)),
        tree_({.dimension = file.sorted()->dimension,
               .capacity = capacity_,
               .buffered_points = buffered_points(plan_),
               .expected = points_.expected(),
               .extent = extent_of(points, file),
               .record_size = record_size_,
               .batches = plan_.batches},
              *scratch_, times_, *this) {}

  PointConversion run() {
    watch_.begin("read", "points");
    deal();
    watch_.end(points_.points_read());
    divide();
    if (!tree_.nests()) {
      tree_.divide_evenly();
      divide();
    }
    watch_.begin("write", "points");
    write();
    watch_.end(tree_.points());
    PointConversion done = file_.complete();
    done.points = points_.counts();
    if (files_ != nullptr) done.skipped_files = files_->skipped();
    done.cells = cells_;
    done.spilled_points = tree_.points_written();
    done.spilled_bytes = tree_.bytes_written();
    return done;
  }

 private:
  /// Deals the points as the file will have them, so that points that rounding makes equal stay
  /// together.
  void deal() {
    PlacedPoints placed(points_, file_, watch_);
    if (file_.decided()) return tree_.fill(placed);
    SourcePiece piece;  // the first points decide, so they come before others
    tree_.fill([&](PointBlock& block) {
      block.clear();
      while (block.size() == 0 && placed.fetch(piece)) placed.decode(piece, block);
      return block.size() > 0;
    });
  }

  /// Where it is not known how many points come: what is known of cells must not outgrow memory.
  [[nodiscard]] std::size_t capacity_for(std::uint64_t points) override {
    if (points_.expected()) return 0;
    return capacity_ = cell_capacity(*file_.sorted(), plan_, points);
  }

  void dealt_again(std::uint64_t points, double fraction) override {
    watch_.tell(points, fraction);
  }

  void divide() {
    if (tree_.points_to_divide() == 0) return;
    watch_.begin("divide", "points");
    watch_.end(tree_.divide_large());
  }

  void write() {
    // Boxes have z even where that was not divided.
    const std::optional<TileNode<3>> root = tree_.take_nodes<3>();
    std::vector<const TileNode<3>*> cells;
    if (root) cells = cells_in_order(*root, file_.sorted()->dimension);
    cells_ = cells.size();
    std::vector<PointRegion> regions;
    regions.reserve(cells.size());
    for (const TileNode<3>* const cell : cells) regions.push_back({cell->box, cell->points});
    file_.append_regions(regions);
    write_points(cells);
  }

  void write_points(std::span<const TileNode<3>* const> cells) {
    struct Slot {
      StoredTile stored;
      PointBlock points;
    };
    const auto room = static_cast<std::size_t>(static_cast<double>(memory_) * kWrittenShare);
    std::vector<Slot> slots(std::clamp<std::size_t>(
        room / ((kPointBytes + kRecords * record_size_) * capacity_), 1, kMostUnderWay));
    std::size_t taken = 0;
    const auto read = [&](std::size_t slot) {
      if (taken == cells.size()) return false;
      slots[slot].stored = tree_.loader().read(*cells[taken++]);
      return true;
    };
    const auto decode = [&](std::size_t slot) {
      StoredTile& stored = slots[slot].stored;
      PointBlock& points = slots[slot].points;
      points.clear();
      if (stored.points > capacity_) return;  // equal points, which may be too many for the memory
      drain_points(stored, [&](const PointsView& some) { some.append_to(points); });
    };
    const auto append = [&](std::size_t slot) {
      StoredTile& stored = slots[slot].stored;
      file_.append_placed(PointsView::of(slots[slot].points));
      if (stored.points > capacity_) {
        drain_points(stored, [&](const PointsView& some) { file_.append_placed(some); });
      }
      written_ += stored.points;
      watch_.tell(written_, static_cast<double>(written_) / static_cast<double>(tree_.points()));
    };
    run_pipeline(slots.size(), read,
                 std::vector<PipelineStep>{{.in_order = false, .work = decode},
                                           {.in_order = true, .work = append}});
  }

  PointStream& points_;
  const stream::JoinedInputs* files_;
  PointFile& file_;
  RunWatch& watch_;
  std::uint64_t memory_;
  std::size_t record_size_;
  MemoryPlan plan_;
  std::size_t capacity_;
  std::shared_ptr<ScratchFolder> scratch_;
  StageTimes times_;
  TileTree tree_;
  std::uint64_t cells_ = 0;
  std::uint64_t written_ = 0;
};

}  // namespace

PointConversion sort_points(const RunPoints& points, PointFile& file, const Context& context,
                            RunWatch& watch) {
  file.start(points);
  Sorting sorting(points, file, context, watch);
  PointConversion done;
  with_threads(context.threads(), [&] { done = sorting.run(); });
  return done;
}

}  // namespace spillway::stream
