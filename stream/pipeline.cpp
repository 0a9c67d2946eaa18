#include "stream/pipeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <future>
#include <memory>
#include <mutex>
#include <utility>

#include "src/delaunay/base_case.h"
#include "src/error.h"
#include "src/parallel/parallel.h"
#include "stream/memory_plan.h"
#include "stream/sequencer.h"
#include "stream/tile_tree.h"
#include "stream/tile_triangulation.h"

namespace spillway {
namespace {

/// Tiles that are triangulated beside each other. Two, so that there is something to do while the
/// last merges of one tile leave threads idle; the next one is being read meanwhile.
constexpr std::size_t kTilesAtATime = 2;

template <int D>
class Pipeline {
 public:
  Pipeline(PointSource& source, MeshStreamWriter& writer, ScratchFolder& scratch,
           MemoryBudget& budget, const StreamOptions& options)
      : source_(source),
        options_(options),
        budget_(budget),
        plan_(plan_memory(budget.limit(), D, options.threads)),
        tile_options_(tile_options()),
        tree_(tree_options(), scratch, counts_.times),
        sequencer_(writer, tile_options_.output, counts_.times) {}

  StreamFigures run() {
    figures_.threads = plan_.threads;
    with_threads(plan_.threads, [&] {
      spill();
      triangulate();
    });
    release_base_case_memory();
    collect_figures();
    return std::move(figures_);
  }

 private:
  [[nodiscard]] TileOptions tile_options() const {
    TileOptions tile;
    tile.division = options_.division;
    tile.children = options_.children;
    tile.heights = options_.heights;
    tile.budget = &budget_;
    tile.output = {source_.lattice(), options_.max_edge, options_.input_index};
    return tile;
  }

  TileTreeOptions tree_options() {
    if (options_.tile_capacity > 0) plan_.tile_capacity = options_.tile_capacity;
    if (options_.buffered_points > 0) plan_.buffered_points = options_.buffered_points;
    if (options_.input_index) plan_.buffered_points = plan_.buffered_points * 3 / 4;
    return {.dimension = D,
            .capacity = plan_.tile_capacity,
            .buffered_points = plan_.buffered_points,
            .expected = source_.expected(),
            .extent = source_.extent(),
            .index = options_.input_index};
  }

  void spill() {
    options_.begin_phase("read");
    const Stopwatch watch(figures_.read_seconds);
    const MemoryLease buffers(budget_, plan_.buffered_points * sizeof(Point<3>),
                              "points that wait to be spilled");
    tree_.fill({.fetch =
                    [&](SourcePiece& piece) {
                      const StageTimer timer(counts_.times, Stage::kRead);
                      options_.progress(source_.points_read(), source_.fraction_read());
                      return source_.fetch(piece);
                    },
                .decode =
                    [&](SourcePiece& piece, PointBlock& block) {
                      const StageTimer timer(counts_.times, Stage::kRead);
                      source_.decode(piece, block);
                    }});
    options_.end_phase();
  }

  void triangulate() {
    options_.begin_phase("triangulate");
    const Stopwatch watch(figures_.triangulate_seconds);
    const std::uint64_t points = tree_.points();
    tile_options_.leaf_size =
        options_.leaf_size > 0 ? options_.leaf_size : leaf_size_for(points, D, plan_);
    root_ = tree_.template nodes<D>();
    if (!root_) throw Error("the input has no points: " + describe(source_.counts()));
    const Box<D>& box = root_->box;
    options_.extent_known({{box.lo[0], box.lo[1]}, {box.hi[0], box.hi[1]}});
    add_node(*root_, nullptr, {}, figures_.tasks);
    figures_.tiles = tiles_.size();
    figures_.final_by_level.resize(nodes_.back()->level);
    TaskGroup lanes;
    // Isolated, since a merge that took up the other lane while it waits could end up waiting for
    // room in the sequencer, which only it can make.
    const auto lane = [this] { isolated([this] { work_off_tiles(); }); };
    for (std::size_t other = 1; other < kTilesAtATime; ++other) lanes.run(lane);
    lane();
    lanes.wait();
    const Border<D>& left = nodes_.back()->border;
    if (left.open()) refuse(left, points);
    options_.end_phase();
  }

  /// A tile, or a merge of tiles. Its place in nodes_, which is post-order, is its slot of the
  /// stream.
  struct Node {
    const TileNode<D>* tiles = nullptr;
    Node* parent = nullptr;
    Outside<D> outside;
    Task* task = nullptr;
    std::uint32_t slot = 0;
    std::size_t level = 0;  ///< merges below, at most
    std::vector<Node*> children;
    std::atomic<std::size_t> children_missing = 0;
    Border<D> border;
  };

  Node* add_node(const TileNode<D>& tiles, Node* parent, const Outside<D>& outside, Task& task) {
    auto node = std::make_unique<Node>();
    node->tiles = &tiles;
    node->parent = parent;
    node->outside = outside;
    node->task = &task;
    node->children_missing = tiles.children.size();
    task.kind = "node";
    task.points = tiles.points;
    task.children.resize(tiles.children.size());
    for (std::size_t c = 0; c < tiles.children.size(); ++c) {
      Outside<D> others = outside;
      for (std::size_t o = 0; o < tiles.children.size(); ++o) {
        if (o != c) others.push_back(&tiles.children[o]);
      }
      node->children.push_back(add_node(tiles.children[c], node.get(), others, task.children[c]));
      node->level = std::max(node->level, node->children.back()->level + 1);
    }
    node->slot = static_cast<std::uint32_t>(nodes_.size());
    if (tiles.children.empty()) tiles_.push_back(node.get());
    nodes_.push_back(std::move(node));
    return nodes_.back().get();
  }

  /// Takes tiles in order as long as there are any; after the last child of a merge, does that too.
  void work_off_tiles() {
    try {
      for (;;) {
        TilePoints<D> points;
        Node* node = take_tile(points);
        if (node == nullptr) return;
        node->border = triangulate_tile<D>(
            std::move(points), node->outside, tile_options_, sequencer_, counts_, node->slot,
            [&] { report_progress(); }, *node->task);
        lease_borders();
        for (node = node->parent; node != nullptr && --node->children_missing == 0;
             node = node->parent) {
          merge(*node);
        }
      }
    } catch (...) {
      failed_ = true;
      sequencer_.give_up();
      throw;
    }
  }

  /// The next tile and its points; null at the end, or if the run has failed. What is on the disk
  /// of it has been read ahead, and the reading of the one after it begins.
  Node* take_tile(TilePoints<D>& points) {
    StoredTile stored;
    Node* node = nullptr;
    {
      const std::lock_guard lock(take_mutex_);
      if (taken_ == tiles_.size() || failed_) return nullptr;
      node = tiles_[taken_++];
      sequencer_.wait_for_room(plan_.waiting_bytes, node->slot);
      stored = reading_ahead_.valid() ? reading_ahead_.get() : tree_.read(*node->tiles);
      if (taken_ < tiles_.size()) {
        reading_ahead_ = std::async(
            std::launch::async, [this, next = tiles_[taken_]->tiles] { return tree_.read(*next); });
      }
    }
    points = tree_.template decode<D>(std::move(stored));
    return node;
  }

  void merge(Node& node) {
    std::vector<Border<D>> borders;
    for (Node* child : node.children) borders.push_back(std::exchange(child->border, {}));
    std::uint64_t final_simplices = 0;
    node.border = merge_tiles<D>(borders, *node.tiles, node.outside, tile_options_, sequencer_,
                                 counts_, node.slot, final_simplices, *node.task);
    lease_borders();
    const std::lock_guard lock(figures_mutex_);
    figures_.final_by_level[node.level - 1] += final_simplices;
  }

  void report_progress() const {
    const std::uint64_t done = counts_.points;
    options_.progress(done, static_cast<double>(done) / static_cast<double>(tree_.points()));
  }

  /// Borders are what grows with the input: they must not outgrow the budget.
  void lease_borders() {
    const std::lock_guard lock(figures_mutex_);
    border_lease_ = {};
    border_lease_ = MemoryLease(budget_, counts_.borders.bytes(), "the border between tiles");
  }

  /// Says plainly why points that do not span D dimensions have no triangulation.
  [[noreturn]] void refuse(const Border<D>& border, std::uint64_t points) const {
    const char* simplex = D == 2 ? "triangle" : "tetrahedron";
    const std::size_t distinct = border.vertices.size();
    if (distinct <= D) {
      throw Error(fmt::format("the input has only {} distinct point{}: a {} needs {}", distinct,
                              distinct == 1 ? "" : "s", simplex, D + 1));
    }
    throw Error(fmt::format("all {} points lie {}: there is no {} to make{}", points,
                            border.dimension == 1 ? "on one line" : "in one plane", simplex,
                            border.dimension == 2 ? " (--dim 2 makes triangles)" : ""));
  }

  void collect_figures() {
    figures_.totals = sequencer_.totals();
    figures_.totals.points = tree_.points();
    figures_.totals.duplicates = counts_.duplicates;
    if (!options_.max_edge) figures_.totals.hull_facets = counts_.hull_facets;
    figures_.left_out = counts_.left_out;
    figures_.leaves = counts_.leaves;
    figures_.tile_capacity = plan_.tile_capacity;
    figures_.leaf_size = tile_options_.leaf_size;
    figures_.spilled_points = tree_.points_written();
    figures_.spilled_bytes = tree_.bytes_written();
    figures_.final_in_leaves = counts_.final_in_leaves;
    figures_.final_in_tiles = counts_.final_in_tiles;
    figures_.retriangulated = counts_.retriangulated;
    figures_.border_simplices = counts_.borders.most_simplices();
    figures_.border_bytes = counts_.borders.most_bytes();
    for (std::size_t s = 0; s < kStageNames.size(); ++s) {
      figures_.stage_seconds[s] = counts_.times.seconds(static_cast<Stage>(s));
    }
  }

  PointSource& source_;
  const StreamOptions& options_;
  MemoryBudget& budget_;
  MemoryPlan plan_;
  TileOptions tile_options_;
  StreamCounts counts_;
  TileTree tree_;
  Sequencer<D> sequencer_;
  std::optional<TileNode<D>> root_;
  std::vector<std::unique_ptr<Node>> nodes_;  ///< in post-order
  std::vector<Node*> tiles_;                  ///< those of nodes_ without children, in order
  std::mutex take_mutex_;                     ///< guards the next three
  std::size_t taken_ = 0;
  std::future<StoredTile> reading_ahead_;
  std::atomic<bool> failed_ = false;
  std::mutex figures_mutex_;  ///< guards the next two
  MemoryLease border_lease_;
  StreamFigures figures_;
};

}  // namespace

template <int D>
StreamFigures triangulate_stream(PointSource& source, MeshStreamWriter& writer,
                                 ScratchFolder& scratch, MemoryBudget& budget,
                                 const StreamOptions& options) {
  return Pipeline<D>(source, writer, scratch, budget, options).run();
}

template StreamFigures triangulate_stream<2>(PointSource&, MeshStreamWriter&, ScratchFolder&,
                                             MemoryBudget&, const StreamOptions&);
template StreamFigures triangulate_stream<3>(PointSource&, MeshStreamWriter&, ScratchFolder&,
                                             MemoryBudget&, const StreamOptions&);

}  // namespace spillway
