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
/// Tiles and merges that may be ready before the thread that reads lends a hand.
constexpr std::size_t kMostReady = 1;

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
      plan_(plan_memory(budget.limit(), D, options.threads, budget.whole(),
                        expected.plan != nullptr)),
      planned_tile_(plan_.tile_capacity),
      counts_(budget),
      expected_points_(expected.count.value_or(0)),
      tree_(tree_options(expected), scratch, counts_.times),
      sequencer_(sink, {.max_edge = options.max_edge}, counts_.times),
      context_{.options = tile_options(expected.lattice),
               .budget = budget,
               .sequencer = sequencer_,
               .counts = counts_,
               .progress = [this] { report_progress(); }} {
  if (expected.plan == nullptr) return;
  cells_.emplace(*expected.plan);
  parts_.resize(cells_->parts());
}

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
          .batches = plan_.batches,
          .plan = expected.plan,
          .one_of_equal = options_.heights};
}

template <int D>
void TileEngine<D>::spill(const PointFeed& feed) {
  const Stopwatch watch(figures_.read_seconds);
  const MemoryLease buffers(budget_, plan_.buffered_points * sizeof(LatticePoint),
                            "points that wait to be spilled");
  const PointFeed spanned = {.fetch = feed.fetch,
                             .decode = [&](SourcePiece& piece, PointBlock& block) {
                               budget_.give_back_freed();
                               feed.decode(piece, block);
                               span_.add(block.points);
                             }};
  if (!cells_) return tree_.fill(spanned);
  begin_triangulating(expected_points_, expected_points_);
  TaskGroup lanes;
  try {
    tree_.fill(spanned, [&](std::uint32_t cell) {
      add_cell(cell);
      triangulate_ahead(lanes);
    });
    lanes.wait();
  } catch (...) {
    give_up();
    throw;
  }
}

template <int D>
std::uint64_t TileEngine<D>::divide_large() {
  const Stopwatch watch(figures_.divide_seconds);
  const MemoryLease buffers(budget_, plan_.buffered_points * sizeof(LatticePoint),
                            "points that wait to be spilled");
  return figures_.divided_points =
             tree_.divide_large([this](std::uint64_t points, double fraction) {
               budget_.give_back_freed();
               options_.progress(points, fraction);
             });
}

template <int D>
void TileEngine<D>::begin_triangulating(std::uint64_t points, std::uint64_t all_points) {
  context_.options.leaf_size =
      options_.leaf_size > 0 ? options_.leaf_size : leaf_size_for(points, D, plan_);
  sequencer_.tell_first_block([this] { figures_.first_block_read_points = tree_.points(); });
  estimate_shortages(all_points);
}

template <int D>
Border<D> TileEngine<D>::triangulate(const TileNode<D>& root, const Outside<D>& outside) {
  const Stopwatch watch(figures_.triangulate_seconds);
  std::uint64_t all_points = root.points;
  for (const TileNode<D>* const other : outside) all_points += other->points;
  begin_triangulating(tree_.points(), all_points);
  tells_progress_ = true;
  Node* const top = add_nodes(root, outside, nullptr);
  work_off_all();
  return std::move(top->border);
}

template <int D>
void TileEngine<D>::triangulate_rest() {
  const Stopwatch watch(figures_.triangulate_seconds);
  tells_progress_ = true;
  for (const std::uint32_t cell : tree_.finish()) add_cell(cell);
  work_off_all();
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

/// The tiles of a cell are ready, and merges with what is complete beside it follow.
template <int D>
void TileEngine<D>::add_cell(std::uint32_t cell) {
  auto complete = cells_->complete(cell, tree_.template take_cell<D>(cell));
  const auto surrounded = [](const auto& part) {
    return std::make_shared<const Surroundings>(Surroundings{part.node, part.outside});
  };
  const auto outside_of = [](const Surroundings& surroundings) {
    Outside<D> outside;
    for (const auto& other : surroundings.outside) outside.push_back(other.get());
    return outside;
  };
  if (complete.node) {
    const auto surroundings = surrounded(complete);
    parts_[complete.part] = add_nodes(*surroundings->root, outside_of(*surroundings), surroundings);
  }
  for (const auto& join : complete.joins) {
    const auto surroundings = surrounded(join);
    parts_[join.part] = add_node({.tree = surroundings->root.get(),
                                  .outside = outside_of(*surroundings),
                                  .surroundings = surroundings,
                                  .outside_shrank = true},
                                 {parts_[join.below[0]], parts_[join.below[1]]});
  }
}

/// Adds the nodes of a tree, those of tiles in order.
template <int D>
typename TileEngine<D>::Node* TileEngine<D>::add_nodes(
    const TileNode<D>& tree, const Outside<D>& outside,
    const std::shared_ptr<const Surroundings>& surroundings) {
  std::vector<Node*> children;
  for (const TileNode<D>& child : tree.children) {
    Outside<D> others = outside;
    for (const TileNode<D>& other : tree.children) {
      if (&other != &child) others.push_back(&other);
    }
    children.push_back(add_nodes(child, others, surroundings));
  }
  if (tree.leaf()) {
    ++figures_.tiles;
    count_shape(tree.box, figures_.tile_shapes);
  }
  return add_node({.tree = &tree, .outside = outside, .surroundings = surroundings},
                  std::move(children));
}

template <int D>
typename TileEngine<D>::Node* TileEngine<D>::add_node(State state, std::vector<Node*> children) {
  for (const Node* child : children) state.level = std::max(state.level, child->level + 1);
  const auto [node, ready] = forest_.add(std::move(state), std::move(children));
  if (ready) {
    const std::lock_guard lock(take_mutex_);
    ready_.push_back(node);
  }
  return node;
}

/// While points are being read: as many tiles as there may be are worked off beside that, and if
/// more are ready, this thread, which would bring still more, lends a hand.
template <int D>
void TileEngine<D>::triangulate_ahead(TaskGroup& lanes) {
  if (failed_) lanes.wait();  // throws what a lane has thrown
  bool more_lanes = false;
  {
    const std::lock_guard lock(take_mutex_);
    more_lanes = !ready_.empty() && lanes_ + 1 < kTilesAtATime;
    if (more_lanes) ++lanes_;
  }
  if (more_lanes) {
    lanes.run([this] { isolated([this] { work_off_ready(); }); });
  }
  const auto too_many = [this] {
    const std::lock_guard lock(take_mutex_);
    return ready_.size() > kMostReady;
  };
  while (too_many()) isolated([this] { work_off_one(); });
}

/// All that is ready, and all above it.
template <int D>
void TileEngine<D>::work_off_all() {
  TaskGroup group;
  // Isolated, since a merge that took up the other lane while it waits could end up waiting for
  // room in the sequencer, which only it can make.
  const auto lane = [this] { isolated([this] { work_off_ready(); }); };
  lanes_ = kTilesAtATime;
  for (std::size_t other = 1; other < kTilesAtATime; ++other) group.run(lane);
  lane();
  group.wait();
}

/// A lane: until nothing is ready.
template <int D>
void TileEngine<D>::work_off_ready() {
  while (work_off_one()) {
  }
  const std::lock_guard lock(take_mutex_);
  --lanes_;
}

/// Takes what is next; after the last child of a merge, does that too. False if nothing is ready.
template <int D>
bool TileEngine<D>::work_off_one() {
  try {
    StoredTile stored;
    Node* const node = take_ready(stored);
    if (node == nullptr) return false;
    work_off(*node, std::move(stored));
    return true;
  } catch (...) {
    give_up();
    throw;
  }
}

/// Of a tile that is larger than planned, of equal points or by --tile, only what others may have
/// is leased.
template <int D>
void TileEngine<D>::work_off(Node& node, StoredTile stored) {
  if (node.children.empty()) {
    TilePoints<D> points = tree_.template decode<D>(std::move(stored));
    if (replace_indices_) replace_indices_(points.index);
    Task task;
    {
      const MemoryLease lease(
          budget_, std::min(points.points.size(), planned_tile_) * kLoadedPointBytes, "a tile");
      node.border =
          triangulate_tile<D>(context_, {std::move(points), node.outside, node.number}, task);
    }
    growth_.add_tile(node.tree->size(), node.border);
    tasks_.add_tile(task);
    tell_done(node, std::move(task));
    node.outside = {};
  } else {
    merge_node(node);
  }
  for (Node* above = forest_.done(node); above != nullptr; above = forest_.done(*above)) {
    merge_node(*above);
  }
}

template <int D>
void TileEngine<D>::give_up() {
  failed_ = true;
  sequencer_.give_up();
  const std::lock_guard lock(take_mutex_);
  if (reading_ahead_.valid()) reading_ahead_.wait();  // the tree that it reads from may go now
}

/// The next tile and its points, or the next merge; null if nothing is ready, or if the run has
/// failed. What is on the disk of a tile has been read ahead, and the reading of the one after it
/// begins.
template <int D>
typename TileEngine<D>::Node* TileEngine<D>::take_ready(StoredTile& stored) {
  const std::lock_guard lock(take_mutex_);
  if (ready_.empty() || failed_) return nullptr;
  Node* const node = ready_.front();
  ready_.pop_front();
  if (!node->children.empty()) return node;
  sequencer_.wait_for_room(plan_.waiting_bytes, node->number);
  stored = reading_ahead_.valid() ? reading_ahead_.get() : tree_.read(*node->tree);
  const auto next =
      std::ranges::find_if(ready_, [](const Node* other) { return other->children.empty(); });
  if (next != ready_.end() && tree_.on_disk(*(*next)->tree)) {
    reading_ahead_ =
        std::async(std::launch::async, [this, tree = (*next)->tree] { return tree_.read(*tree); });
  }
  return node;
}

template <int D>
void TileEngine<D>::merge_node(Node& node) {
  std::vector<Border<D>> borders;
  for (Node* child : node.children) borders.push_back(std::exchange(child->border, {}));
  growth_.begin_merge(node.tree->size(), borders);
  Task task{.points = node.tree->size()};
  MergedTiles<D> merged = merge_tiles<D>(context_,
                                         {.children = borders,
                                          .node = *node.tree,
                                          .outside = node.outside,
                                          .place = {node.number, 0},
                                          .outside_shrank = node.outside_shrank},
                                         task);
  node.border = std::move(merged.border);
  growth_.end_merge(task.after.front().points, node.border);
  tasks_.add_merge(TaskScope::kBetweenTiles, node.level, task);
  tell_done(node, std::move(task));
  node.outside = {};
  node.surroundings = {};
  const std::lock_guard lock(figures_mutex_);
  if (figures_.final_by_level.size() < node.level) figures_.final_by_level.resize(node.level);
  figures_.final_by_level[node.level - 1] += merged.final_simplices;
}

template <int D>
void TileEngine<D>::tell_done(const Node& node, Task task) {
  if (!options_.task_done) return;
  TaskNode told{.number = node.number, .level = node.level};
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
  if (!tells_progress_) return;
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
