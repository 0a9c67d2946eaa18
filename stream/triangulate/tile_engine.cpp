#include "stream/triangulate/tile_engine.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "src/delaunay/base_case.h"
#include "src/error.h"
#include "src/parallel/parallel.h"

namespace spillway::detail {
namespace {

/// Tiles that are triangulated at the same time. Two, so that there is something to do while the
/// last merges of one tile leave threads idle; the next one is being read meanwhile.
constexpr std::size_t kTilesAtATime = 2;

template <int D>
void count_shape(const Box<D>& box, TileShapes& shapes) {
  const double longest = box.extent(box.longest_axis());
  double shortest = longest;
  for (int k = 0; k < D; ++k) shortest = std::min(shortest, box.extent(k));
  if (longest <= 2 * shortest) {
    ++shapes.up_to_twice;
  } else {
    ++(longest <= 4 * shortest ? shapes.up_to_4_times : shapes.longer);
  }
}

}  // namespace

template <int D>
TileEngine<D>::TileEngine(const ExpectedPoints& expected, BlockSink& sink, ScratchFolder& scratch,
                          MemoryBudget& budget, const StreamOptions& options)
    : options_(options),
      budget_(budget),
      plan_(plan_memory(budget.limit(), D, options.threads, budget.whole())),
      planned_tile_(plan_.tile_capacity),
      counts_(budget),
      tree_(tree_options(expected), scratch, counts_.times),
      sequencer_(sink, {.max_edge = options.max_edge}, counts_.times),
      context_{.options = tile_options(expected.lattice),
               .budget = budget,
               .sequencer = sequencer_,
               .counts = counts_,
               .progress = [this] { report_progress(); }} {}

template <int D>
TileOptions TileEngine<D>::tile_options(const std::optional<Lattice>& lattice) const {
  TileOptions tile;
  tile.division = options_.division;
  tile.children = options_.children;
  tile.kernel = options_.kernel;
  tile.heights = options_.heights;
  tile.output = {lattice, options_.max_edge, options_.input_index};
  return tile;
}

template <int D>
TileTreeOptions TileEngine<D>::tree_options(const ExpectedPoints& expected) {
  if (options_.tile_capacity > 0) plan_.tile_capacity = options_.tile_capacity;
  if (options_.buffered_points > 0) plan_.buffered_points = options_.buffered_points;
  const bool index = options_.input_index || expected.ordered_by_index;
  if (index) plan_.buffered_points = plan_.buffered_points * 3 / 4;
  return {.dimension = D,
          .capacity = plan_.tile_capacity,
          .buffered_points = plan_.buffered_points,
          .expected = expected.count,
          .extent = expected.extent,
          .index = index,
          .batches = plan_.batches};
}

template <int D>
void TileEngine<D>::spill(const PointFeed& feed) {
  const Stopwatch watch(figures_.read_seconds);
  const MemoryLease buffers(budget_, plan_.buffered_points * sizeof(LatticePoint),
                            "points that wait to be spilled");
  tree_.fill({.fetch = feed.fetch, .decode = [&](SourcePiece& piece, PointBlock& block) {
                feed.decode(piece, block);
                span_.add(block.points);
              }});
}

template <int D>
std::uint64_t TileEngine<D>::divide_large() {
  const Stopwatch watch(figures_.divide_seconds);
  const MemoryLease buffers(budget_, plan_.buffered_points * sizeof(LatticePoint),
                            "points that wait to be spilled");
  return figures_.divided_points = tree_.divide_large(options_.progress);
}

template <int D>
Border<D> TileEngine<D>::triangulate(const TileNode<D>& root, const Outside<D>& outside) {
  const Stopwatch watch(figures_.triangulate_seconds);
  context_.options.leaf_size =
      options_.leaf_size > 0 ? options_.leaf_size : leaf_size_for(tree_.points(), D, plan_);
  nodes_.emplace(root);
  prepare_nodes(outside);
  std::uint64_t all_points = root.points;
  for (const TileNode<D>* const other : outside) all_points += other->points;
  estimate_shortages(all_points);
  figures_.tiles = nodes_->leaves().size();
  for (const Node* tile : nodes_->leaves()) count_shape(tile->tree->box, figures_.tile_shapes);
  figures_.final_by_level.resize(nodes_->root().level);
  TaskGroup lanes;
  // Isolated, since a merge that took up the other lane while it waits could end up waiting for
  // room in the sequencer, which only it can make.
  const auto lane = [this] { isolated([this] { work_off_tiles(); }); };
  for (std::size_t other = 1; other < kTilesAtATime; ++other) lanes.run(lane);
  lane();
  lanes.wait();
  return std::move(nodes_->root().border);
}

/// From now on refusals tell what will do for so many points.
template <int D>
void TileEngine<D>::estimate_shortages(std::uint64_t all_points) {
  budget_.set_estimate([this, all_points](std::uint64_t used, std::uint64_t refused) {
    return growth_.enough_for({.limit = budget_.limit(),
                               .used = used,
                               .refused = refused,
                               .loaded = kTilesAtATime * planned_tile_,
                               .all_points = all_points});
  });
}

/// `outside` is that of the root.
template <int D>
void TileEngine<D>::prepare_nodes(const Outside<D>& outside) {
  const std::span<Node> nodes = nodes_->nodes();
  for (Node& node : nodes) {
    for (const Node* child : node.children) node.level = std::max(node.level, child->level + 1);
  }
  for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) {  // parents before children
    node->outside = node->parent == nullptr ? outside : node->parent->outside;
    Tree::append_siblings(*node, node->outside);
  }
}

/// Takes tiles in order as long as there are any; after the last child of a merge, does that too.
/// Of a tile that is larger than planned, of equal points or by --tile, only what others may have
/// is leased.
template <int D>
void TileEngine<D>::work_off_tiles() {
  try {
    for (;;) {
      TilePoints<D> points;
      Node* node = take_tile(points);
      if (node == nullptr) return;
      Task task;
      {
        const MemoryLease lease(
            budget_, std::min(points.points.size(), planned_tile_) * kLoadedPointBytes, "a tile");
        node->border =
            triangulate_tile<D>(context_, {std::move(points), node->outside, node->number}, task);
      }
      growth_.add_tile(node->tree->size(), node->border);
      tasks_.add_tile(task);
      tell_done(*node, std::move(task));
      nodes_->leaf_done(*node, [this](Node& above) { merge_node(above); });
    }
  } catch (...) {
    failed_ = true;
    sequencer_.give_up();
    const std::lock_guard lock(take_mutex_);
    if (reading_ahead_.valid()) reading_ahead_.wait();  // the tree that it reads from may go now
    throw;
  }
}

/// The next tile and its points; null at the end, or if the run has failed. What is on the disk
/// of it has been read ahead, and the reading of the one after it begins.
template <int D>
typename TileEngine<D>::Node* TileEngine<D>::take_tile(TilePoints<D>& points) {
  StoredTile stored;
  Node* node = nullptr;
  {
    const std::lock_guard lock(take_mutex_);
    const std::vector<Node*>& tiles = nodes_->leaves();
    if (taken_ == tiles.size() || failed_) return nullptr;
    node = tiles[taken_++];
    sequencer_.wait_for_room(plan_.waiting_bytes, node->number);
    stored = reading_ahead_.valid() ? reading_ahead_.get() : tree_.read(*node->tree);
    if (taken_ < tiles.size()) {
      reading_ahead_ = std::async(std::launch::async,
                                  [this, next = tiles[taken_]->tree] { return tree_.read(*next); });
    }
  }
  points = tree_.template decode<D>(std::move(stored));
  if (replace_indices_) replace_indices_(points.index);
  return node;
}

template <int D>
void TileEngine<D>::merge_node(Node& node) {
  std::vector<Border<D>> borders;
  for (Node* child : node.children) borders.push_back(std::exchange(child->border, {}));
  growth_.begin_merge(node.tree->size(), borders);
  Task task{.points = node.tree->size()};
  MergedTiles<D> merged =
      merge_tiles<D>(context_, {borders, *node.tree, node.outside, {node.number, 0}}, task);
  node.border = std::move(merged.border);
  growth_.end_merge(task.after.front().points, node.border);
  tasks_.add_merge(TaskScope::kBetweenTiles, static_cast<std::uint32_t>(node.level), task);
  tell_done(node, std::move(task));
  const std::lock_guard lock(figures_mutex_);
  figures_.final_by_level[node.level - 1] += merged.final_simplices;
}

template <int D>
void TileEngine<D>::tell_done(const Node& node, Task task) {
  if (!options_.task_done) return;
  TaskNode told{.number = node.number, .level = static_cast<std::uint32_t>(node.level)};
  for (const Node* child : node.children) told.children.push_back(child->number);
  told.task = std::move(task);
  const std::lock_guard lock(tell_mutex_);
  options_.task_done(std::move(told));
}

/// Nothing of this is for the sequencer: `place` is one of a stream of many processes.
template <int D>
Settled<D> TileEngine<D>::merge(std::span<Border<D>> children, const TileNode<D>& node,
                                const Outside<D>& outside, BlockPlace place, Task& task) {
  growth_.begin_merge(node.size(), children);
  Settled<D> settled = merge_borders_of<D>(context_,
                                           {.children = children,
                                            .node = node,
                                            .outside = outside,
                                            .place = place,
                                            .imported_vertices = true},
                                           task);
  growth_.end_merge(task.after.front().points, settled.border);
  return settled;
}

template <int D>
void TileEngine<D>::take_in(const Border<D>& border) {
  counts_.borders.add(border.simplices.size(), border.bytes());
  growth_.add(border);
}

template <int D>
void TileEngine<D>::hand_over(const Border<D>& border) {
  counts_.borders.remove(border.simplices.size(), border.bytes());
}

template <int D>
void TileEngine<D>::report_progress() const {
  const std::uint64_t done = counts_.points;
  options_.progress(done, static_cast<double>(done) / static_cast<double>(tree_.points()));
}

template <int D>
RunFigures TileEngine<D>::figures() {
  figures_.threads = plan_.threads;
  figures_.mesh = sequencer_.totals();
  figures_.mesh.points = tree_.points();
  figures_.mesh.duplicates = counts_.duplicates;
  if (!options_.max_edge) figures_.mesh.hull_facets = counts_.hull_facets;
  figures_.left_out = counts_.left_out;
  figures_.leaves = counts_.leaves;
  figures_.tile_capacity = plan_.tile_capacity;
  figures_.leaf_size = context_.options.leaf_size;
  figures_.spilled_points = tree_.points_written();
  figures_.spilled_bytes = tree_.bytes_written();
  figures_.final_in_leaves = counts_.final_in_leaves;
  figures_.final_in_tiles = counts_.final_in_tiles;
  figures_.retriangulated = counts_.retriangulated;
  figures_.border_simplices = counts_.borders.most_simplices();
  figures_.border_bytes = counts_.borders.most_bytes();
  figures_.task_sums = tasks_.sums();
  for (std::size_t s = 0; s < kStageNames.size(); ++s) {
    figures_.stages.push_back({kStageNames[s], counts_.times.seconds(static_cast<Stage>(s))});
  }
  return std::move(figures_);
}

template class TileEngine<2>;
template class TileEngine<3>;

}  // namespace spillway::detail
