#include "stream/pipeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
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
            .expected = source_.count(),
            .extent = source_.extent(),
            .index = options_.input_index};
  }

  void spill() {
    options_.begin_phase("read");
    const Stopwatch watch(figures_.read_seconds);
    const MemoryLease buffers(budget_, plan_.buffered_points * sizeof(Point<3>),
                              "points that wait to be spilled");
    tree_.fill([&](PointBlock& block) {
      const StageTimer timer(counts_.times, Stage::kRead);
      const bool more = source_.read(block);
      options_.progress(source_.points_read(), source_.fraction_read());
      return more;
    });
    options_.end_phase();
  }

  void triangulate() {
    options_.begin_phase("triangulate");
    const Stopwatch watch(figures_.triangulate_seconds);
    const std::uint64_t points = tree_.points();
    tile_options_.leaf_size =
        options_.leaf_size > 0 ? options_.leaf_size : leaf_size_for(points, D, plan_);
    figures_.tasks.kind = "stream";
    figures_.tasks.points = points;
    const std::optional<TileNode<D>> root = tree_.template nodes<D>();
    if (!root) throw Error("the input has no points");
    list_tiles(*root);
    figures_.tiles = tiles_.size();
    next_tile_ = tree_.template load<D>(*tiles_[0]);
    const Border<D> left = triangulate_node(*root, {}, figures_.tasks).border;
    if (left.open()) refuse(left, points);
    options_.end_phase();
  }

  void list_tiles(const TileNode<D>& node) {
    if (node.children.empty()) tiles_.push_back(&node);
    for (const TileNode<D>& child : node.children) list_tiles(child);
  }

  struct Done {
    Border<D> border;
    std::size_t level = 0;  ///< merges of tiles below, at most
  };

  Done triangulate_node(const TileNode<D>& node, const Outside<D>& outside, Task& task) {
    if (node.children.empty()) return {triangulate_next_tile(outside, task), 0};
    task.kind = "node";
    task.points = node.points;
    task.children.resize(node.children.size());
    std::vector<Border<D>> borders;
    std::size_t level = 0;
    for (std::size_t c = 0; c < node.children.size(); ++c) {
      Outside<D> others = outside;
      for (std::size_t o = 0; o < node.children.size(); ++o) {
        if (o != c) others.push_back(&node.children[o]);
      }
      Done child = triangulate_node(node.children[c], others, task.children[c]);
      borders.push_back(std::move(child.border));
      level = std::max(level, child.level + 1);
    }
    if (figures_.final_by_level.size() < level) figures_.final_by_level.resize(level);
    Border<D> border =
        merge_tiles<D>(borders, node, outside, tile_options_.output, sequencer_, counts_,
                       next_block_++, figures_.final_by_level[level - 1], task);
    lease_border();
    return {std::move(border), level};
  }

  /// Triangulates the tile that is loaded while the one after it is being read.
  Border<D> triangulate_next_tile(const Outside<D>& outside, Task& task) {
    TilePoints<D> tile = std::exchange(next_tile_, {});
    TaskGroup reading_ahead;
    if (++loaded_ < tiles_.size()) {
      reading_ahead.run([&] { next_tile_ = tree_.template load<D>(*tiles_[loaded_]); });
    }
    Border<D> border = triangulate_tile<D>(
        std::move(tile), outside, tile_options_, sequencer_, counts_, next_block_,
        [&] {
          const std::uint64_t done = counts_.points;
          options_.progress(done, static_cast<double>(done) / static_cast<double>(tree_.points()));
        },
        task);
    reading_ahead.wait();
    lease_border();
    return border;
  }

  /// Borders are what grows with the input: they must not outgrow the budget.
  void lease_border() {
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
  MemoryLease border_lease_;
  std::vector<const TileNode<D>*> tiles_;
  TilePoints<D> next_tile_;
  std::size_t loaded_ = 0;
  std::uint32_t next_block_ = 0;
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
