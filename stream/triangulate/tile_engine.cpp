#include "stream/triangulate/tile_engine.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "src/delaunay/base_case/base_case.h"
#include "src/error.h"
#include "src/geometry/dimensions.h"
#include "src/parallel/most_threads.h"
#include "src/parallel/parallel.h"

namespace spillway::stream {
namespace {

/// Full tiles that there is memory for at the same time, or more smaller ones. Two, so that there
/// is something to do while the last merges of one tile leave threads idle; the next one is being
/// read meanwhile.
constexpr std::size_t kTilesAtATime = 2;

template <int D>
void count_shape(const Box<D>& box, TileShapes& shapes) {
  const double times = aspect(box, cut_axes(D));
  if (times <= 2) {
    ++shapes.up_to_twice;
  } else {
    ++(times <= 4 ? shapes.up_to_4_times : shapes.longer);
  }
}

}  // namespace

template <int D>
TileEngine<D>::TileEngine(const ExpectedPoints& expected, BlockSink& blocks, const RunSetup& setup,
                          Resting& resting)
    : options_(setup.options),
      budget_(setup.budget),
      progress_(setup.progress),
      resting_(resting),
      sink_(setup.sink),
      tells_points_(D == 2 && setup.sink.wants_points()),
      plan_(plan_for(options_.threads, expected.plan != nullptr)),
      counts_(budget_),
      held_points_(budget_),
      sketches_(budget_),
      sees_extent_(expected.see_extent || cut_axes(D) < D),
      expected_points_(expected.count.value_or(0)),
      tree_(tree_options(expected), setup.scratch, counts_.times, *this),
      sequencer_(blocks, budget_, {.max_edge = options_.asked.max_edge}, counts_.times),
      context_{.asked = options_.asked,
               .output = {.lattice = expected.lattice,
                          .max_edge = options_.asked.max_edge,
                          .input_index = options_.asked.input_index,
                          .record_size = options_.record_size,
                          .periodic = options_.periodic ? &*options_.periodic : nullptr},
               .budget = budget_,
               .sequencer = sequencer_,
               .counts = counts_,
               .progress = [this] { report_progress(); }} {
  RunTrace* const trace = options_.asked.trace.get();
  if (trace != nullptr && trace->takes_steps()) {
    counts_.times.tell_steps([trace](const StageStep& step) { trace->step(step); });
  }
  if (trace != nullptr) {
    const MemoryPlan any = plan_for(kMostThreads, expected.plan != nullptr);
    trace->limits({.batches = any.batches,
                   .tile_points = plan_.tile_room,
                   .loaded_points = kTilesAtATime * plan_.tile_room,
                   .ready_points = kTilesAtATime * plan_.tile_room / Lanes::kReadyShare,
                   .waiting_bytes = plan_.waiting_bytes,
                   .threads = any.threads});
  }
  if (expected.plan == nullptr) return;
  cells_.emplace(*expected.plan);
  parts_.resize(cells_->parts());
  begin_triangulating(expected_points_, expected_points_);
}

template <int D>
MemoryPlan TileEngine<D>::plan_for(unsigned threads, bool early) const {
  return plan_memory(budget_.limit(), D, threads, budget_.whole(), early, options_.record_size);
}

template <int D>
TileTreeOptions TileEngine<D>::tree_options(const ExpectedPoints& expected) {
  if (options_.asked.tile_points > 0) {
    plan_.tile_points = options_.asked.tile_points;
  } else if (expected.count) {
    plan_.tile_points = tile_points_for(*expected.count, plan_);
  } else {
    grows_capacity_ = true;
  }
  if (options_.buffered_points > 0) plan_.buffered_points = options_.buffered_points;
  const bool index = options_.asked.input_index || expected.ordered_by_index;
  if (index) plan_.buffered_points = plan_.buffered_points * 3 / 4;
  return {.dimension = cut_axes(D),
          .capacity = plan_.tile_points,
          .buffered_points = plan_.buffered_points,
          .expected = expected.count,
          .extent = expected.extent,
          .index = index,
          .record_size = options_.record_size,
          .sketch_bytes = plan_.sketch_bytes,
          .batches = plan_.batches,
          .plan = expected.plan,
          .largest_undivided = std::min(
              plan_.tile_room, largest_undivided<D>(budget_.limit(), options_.record_size)),
          .one_of_equal = options_.asked.heights,
          .tell_equal = tells_points_ ? std::function([this](const PointsView& points) {
            sink_.take_points(points.points);
          })
                                      : nullptr};
}

template <int D>
void TileEngine<D>::decoded(const PointBlock& points) {
  budget_.give_back_freed();
  span_.add(PointsView::of(points));
  if (sees_extent_) seen_.add(PointsView::of(points));
}

template <int D>
std::size_t TileEngine<D>::capacity_for(std::uint64_t points) {
  return grows_capacity_ ? tile_points_for(points, plan_) : 0;
}

/// What is known of tiles stays in memory until they are triangulated, so there must not be too
/// many.
template <int D>
void TileEngine<D>::tiles_made(std::size_t tiles) {
  constexpr std::uint64_t kTileBytes = 3000;
  constexpr std::uint64_t kMiB = std::uint64_t{1} << 20;
  constexpr std::uint64_t kParts = 4;  // of the limit, one of which tiles may take
  if (tiles * kTileBytes <= budget_.whole() / kParts) return;
  // Tiles are cut in halves, so in the end they may be half full. What is expected may be a lie.
  const std::uint64_t expected = expected_points_ / std::max<std::size_t>(1, tree_.capacity());
  const std::uint64_t all = 2 * std::clamp<std::uint64_t>(expected, tiles, 1000 * tiles);
  throw Failure(
      fmt::format("{} of memory are too little for what is known of {} tiles of at most {} "
                  "points",
                  memory_size_text(budget_.whole()), tiles, tree_.capacity()),
      ErrorCode::kOutOfBudget,
      {.perhaps = (kParts * all * kTileBytes / kMiB + 1) * kMiB, .remedy = Remedy::kMemory});
}

template <int D>
void TileEngine<D>::spill(PointFeed& feed) {
  const Stopwatch watch(statistics_.read_seconds);
  const MemoryLease buffers(budget_, buffer_bytes(), "points that wait to be spilled");
  if (!cells_) return tree_.fill(feed);
  TaskGroup beside;
  beside_ = &beside;
  try {
    add_restored_cells();
    lanes_.work_beside(beside);
    tree_.fill(feed);
    lanes_.come_to_rest(beside);
  } catch (...) {
    lanes_.give_up();
    beside_ = nullptr;
    throw;
  }
  beside_ = nullptr;
}

template <int D>
void TileEngine<D>::cell_done(std::uint32_t cell) {
  add_cell(cell);
  lanes_.work_beside(*beside_);
}

template <int D>
std::uint64_t TileEngine<D>::divide_large() {
  const Stopwatch watch(statistics_.divide_seconds);
  const MemoryLease buffers(budget_, buffer_bytes(), "points that wait to be spilled");
  return statistics_.divided_points = tree_.divide_large();
}

template <int D>
void TileEngine<D>::dealt_again(std::uint64_t points, double fraction) {
  budget_.give_back_freed();
  progress_.tell(points, fraction);
}

/// What points take that wait to be spilled, and sketches of those that have been, at most.
template <int D>
std::uint64_t TileEngine<D>::buffer_bytes() const {
  return plan_.buffered_points * (sizeof(LatticePoint) + options_.record_size) + plan_.sketch_bytes;
}

/// From now on what waits gets less: as much as there is of it is leased.
template <int D>
void TileEngine<D>::lease_held_points() {
  held_points_.take(tree_.held_bytes(), "points that wait to be triangulated");
}

template <int D>
void TileEngine<D>::begin_triangulating(std::uint64_t points, std::uint64_t all_points) {
  context_.leaf_points = options_.asked.leaf_points > 0 ? options_.asked.leaf_points
                                                        : leaf_points_for(points, D, plan_);
  sequencer_.tell_first_block([this] { statistics_.first_block_read_points = tree_.points(); });
  estimate_shortages(all_points);
}

template <int D>
const std::optional<TileNode<D>>& TileEngine<D>::take_nodes() {
  if (!root_) root_ = tree_.template take_nodes<D>(seen_.box());
  return root_;
}

template <int D>
Border<D> TileEngine<D>::triangulate(const TileNode<D>& root, const Outside<D>& outside) {
  const Stopwatch watch(statistics_.triangulate_seconds);
  std::uint64_t all_points = root.points;
  for (const TileNode<D>* const other : outside) all_points += other->points;
  lease_held_points();
  begin_triangulating(tree_.points(), all_points);
  tells_progress_ = true;
  Node* const top = add_nodes(root, outside, nullptr);
  lanes_.work_off();
  left_border_ = {top->border.simplices.size(), top->border.bytes()};
  return std::move(top->border);
}

template <int D>
std::uint64_t TileEngine<D>::triangulate_rest() {
  const Stopwatch watch(statistics_.triangulate_seconds);
  lease_held_points();
  points_before_ = counts_.points;
  tells_progress_ = true;
  add_restored_cells();
  for (const std::uint32_t cell : tree_.finish()) add_cell(cell);
  lanes_.work_off();
  if (!top_->border.simplices.empty()) {
    throw std::logic_error("not all that is final was found to be so: a fault of the program");
  }
  return tree_.points() - points_before_;
}

/// From now on refusals tell what will do for so many points.
template <int D>
void TileEngine<D>::estimate_shortages(std::uint64_t all_points) {
  budget_.set_estimate([this, all_points](const MemoryBudget::Refusal& refusal) {
    const std::uint64_t by_growth = growth_.enough_for({.limit = budget_.limit(),
                                                        .used = refusal.used,
                                                        .refused = refusal.bytes,
                                                        .loaded = kTilesAtATime * plan_.tile_room,
                                                        .all_points = all_points,
                                                        .densest = counts_.densest_leaf,
                                                        .record_size = options_.record_size});
    if (refusal.forecast == nullptr) return by_growth;
    // Work has outgrown what is usual: perhaps all points make that many simplices.
    return std::max({by_growth, enough_for<D>(*refusal.forecast, all_points),
                     enough_for<D>(sample_.forecast(), all_points)});
  });
}

/// The tiles of a cell are ready, and merges with what is complete beside it follow.
template <int D>
void TileEngine<D>::add_cell(std::uint32_t cell) {
  add_cell(cell, tree_.template take_cell<D>(cell));
}

template <int D>
void TileEngine<D>::add_cell(std::uint32_t cell, std::optional<TileNode<D>> tiles) {
  if (options_.checkpoints != nullptr) complete_cells_.push_back({cell, tiles});
  auto complete = cells_->complete(cell, std::move(tiles));
  const auto kept_of = [](const auto& part) {
    return std::make_shared<const KeptTrees<D>>(KeptTrees<D>{part.node, part.outside});
  };
  const auto outside_of = [](const KeptTrees<D>& kept) {
    Outside<D> outside;
    for (const auto& other : kept.outside) outside.push_back(other.get());
    return outside;
  };
  if (complete.node) {
    const auto kept = kept_of(complete);
    parts_[complete.part] = add_nodes(*kept->root, outside_of(*kept), kept);
    top_ = parts_[complete.part];
  }
  for (const auto& join : complete.joins) {
    const auto kept = kept_of(join);
    std::vector<Node*> below;
    for (const std::size_t part : join.below) below.push_back(parts_[part]);
    parts_[join.part] = add_node({.tree = kept->root.get(),
                                  .outside = outside_of(*kept),
                                  .kept = kept,
                                  .outside_shrank = true},
                                 std::move(below));
    top_ = parts_[join.part];
  }
}

/// Adds the nodes of a tree, those of tiles in order.
template <int D>
typename TileEngine<D>::Node* TileEngine<D>::add_nodes(
    const TileNode<D>& tree, const Outside<D>& outside,
    const std::shared_ptr<const KeptTrees<D>>& kept) {
  std::vector<Node*> children;
  for (const TileNode<D>& child : tree.children) {
    Outside<D> others = outside;
    for (const TileNode<D>& other : tree.children) {
      if (&other != &child) others.push_back(&other);
    }
    children.push_back(add_nodes(child, others, kept));
  }
  if (tree.leaf()) {
    ++statistics_.tiles;
    count_shape(tree.box, statistics_.tile_shapes);
    if (tree.sketch) {
      sketches_.take(PointSketch<D>::bytes_of(tree.sketch->plates.size()), "sketches of tiles");
    }
  }
  return add_node({.tree = &tree, .outside = outside, .kept = kept}, std::move(children));
}

template <int D>
typename TileEngine<D>::Node* TileEngine<D>::add_node(EngineNode<D> state,
                                                      std::vector<Node*> children) {
  for (const Node* child : children) state.level = std::max(state.level, child->level + 1);
  const auto [node, ready] = forest_.add(std::move(state), std::move(children));
  if (nodes_before_.has(node->number)) {
    take_kept_border(*node);
  } else if (ready) {
    lanes_.add(*node);
  }
  return node;
}

template <int D>
typename TileEngine<D>::Lanes TileEngine<D>::make_lanes() {
  return {plan_.threads,
          kTilesAtATime * plan_.tile_room,
          {.weight = [this](const Node& node) { return loaded_points(node); },
           .begin = [this](Node& node, const Node* next) { load(node, next); },
           .finish = [this](Node& node) { work_off(node); },
           .follow = [this](Node& node) { merge_above(node); },
           .give_up = [this] { give_up(); },
           .rests = [this](const Node& next) { return rests_before(next); },
           .at_rest = [this] { save(); }}};
}

/// Points that are loaded for a node, of what others may have, too: a tile may be larger than
/// planned by --tile-points.
template <int D>
std::uint64_t TileEngine<D>::loaded_points(const Node& node) const {
  return node.children.empty() ? std::min<std::uint64_t>(node.tree->size(), plan_.tile_room) : 0;
}

/// Takes what a tile has of the tree. What is on the disk of it has been read ahead, and the
/// reading of the one after it begins.
template <int D>
void TileEngine<D>::load(Node& node, const Node* next) {
  raise(last_begun_, node.number);
  read_ahead_ = nullptr;
  if (!node.children.empty()) return;
  sequencer_.wait_for_room(plan_.waiting_bytes, node.number);
  const std::lock_guard lock(load_mutex_);
  node.stored = reading_ahead_.valid() ? reading_ahead_.get() : tree_.loader().read(*node.tree);
  if (next == nullptr || !next->children.empty() || !tree_.loader().on_disk(*next->tree)) return;
  if (rests_before(*next)) return;
  read_ahead_ = next;
  reading_ahead_ = in_background([this, tile = next->tree] { return tree_.loader().read(*tile); });
}

/// Triangulates a tile or merges.
template <int D>
void TileEngine<D>::work_off(Node& node) {
  if (node.children.empty()) {
    Task task;
    {
      const MemoryLease lease(
          budget_, loaded_points(node) * (kLoadedPointBytes + options_.record_size), "a tile");
      held_points_.give_back(node.stored.held_bytes());
      TilePoints<D> points = tree_.loader().template decode<D>(std::move(node.stored));
      sample_.note(points.points);
      if (tells_points_) tell_points(points);
      if (replace_indices_) replace_indices_(points.index);
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
}

/// Tells the sink of a tile's points, unless all of them were told of when one was made of them.
template <int D>
void TileEngine<D>::tell_points(const TilePoints<D>& points) {
  if constexpr (D == 2) {
    if (points.left_out > 0) return;
    constexpr std::size_t kPointsAtATime = 1 << 14;
    parallel_for(points.points.size(), kPointsAtATime,
                 [&](std::size_t, std::size_t begin, std::size_t end) {
                   std::vector<LatticePoint> some;
                   some.reserve(end - begin);
                   for (std::size_t i = begin; i < end; ++i) {
                     const Point<2>& p = points.points[i];
                     some.emplace_back(p[0], p[1], points.heights[i]);
                   }
                   sink_.take_points(some);
                 });
  }
}

/// Merges for which this node was the last child, and so on.
template <int D>
void TileEngine<D>::merge_above(Node& node) {
  for (Node* above = forest_.done(node); above != nullptr; above = forest_.done(*above)) {
    merge_node(*above);
  }
}

template <int D>
void TileEngine<D>::give_up() {
  sequencer_.give_up();
  const std::lock_guard lock(load_mutex_);
  if (reading_ahead_.valid()) reading_ahead_.wait();  // the tree that it reads from may go now
}

template <int D>
void TileEngine<D>::merge_node(Node& node) {
  raise(last_begun_, node.number);
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
  node.kept = {};
  const std::lock_guard lock(statistics_mutex_);
  if (statistics_.final_by_level.size() < node.level) statistics_.final_by_level.resize(node.level);
  statistics_.final_by_level[node.level - 1] += merged.final_simplices;
}

template <int D>
void TileEngine<D>::tell_done(const Node& node, Task task) {
  RunTrace* const trace = options_.asked.trace.get();
  if (trace == nullptr || !trace->takes_nodes()) return;
  TaskNode told{.number = node.number, .level = node.level};
  for (const Node* child : node.children) told.children.push_back(child->number);
  told.task = std::move(task);
  const std::lock_guard lock(tell_mutex_);
  trace->node(told);
}

template <int D>
void TileEngine<D>::hold_border(std::uint64_t simplices, std::uint64_t bytes) {
  counts_.borders.remove(left_border_[0], left_border_[1]);
  left_border_ = {};
  counts_.borders.add(simplices, bytes);
  left_border_ = {simplices, bytes};
}

template <int D>
void TileEngine<D>::report_progress() const {
  if (!tells_progress_) return;
  const std::uint64_t done = counts_.points - points_before_;
  const std::uint64_t all = tree_.points() - points_before_;
  progress_.tell(done, all > 0 ? static_cast<double>(done) / static_cast<double>(all) : 1);
}

template <int D>
RunStatistics TileEngine<D>::statistics() {
  statistics_.threads = plan_.threads;
  statistics_.mesh = sequencer_.totals();
  statistics_.mesh.points = tree_.points();
  statistics_.mesh.duplicates = counts_.duplicates;
  if (!options_.asked.max_edge) statistics_.mesh.hull_facets = counts_.hull_facets;
  statistics_.left_out = counts_.left_out;
  statistics_.leaves = counts_.leaves;
  statistics_.tile_points = tree_.capacity();
  statistics_.leaf_points = context_.leaf_points;
  statistics_.spilled_points = tree_.points_written();
  statistics_.spilled_bytes = tree_.bytes_written();
  statistics_.final_in_leaves = counts_.final_in_leaves;
  statistics_.final_in_tiles = counts_.final_in_tiles;
  statistics_.retriangulated = counts_.retriangulated;
  statistics_.border_simplices = counts_.borders.most_simplices();
  statistics_.border_bytes = counts_.borders.most_bytes();
  for (std::size_t s = 0; s < kStageNames.size(); ++s) {
    statistics_.stages.push_back({kStageNames[s], counts_.times.seconds(static_cast<Stage>(s))});
  }
  return std::move(statistics_);
}

#define SPILLWAY_INSTANTIATE(D) template class TileEngine<D>;
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::stream
