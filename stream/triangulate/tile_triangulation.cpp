#include "stream/triangulate/tile_triangulation.h"

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>
#include <optional>
#include <utility>

#include "src/delaunay/base_case/base_case.h"
#include "src/delaunay/border/conflict_region_batch.h"
#include "src/delaunay/border/point_search.h"
#include "src/delaunay/division/filled_share.h"
#include "src/delaunay/division/point_tree.h"
#include "src/geometry/dimensions.h"
#include "src/parallel/parallel.h"
#include "stream/triangulate/leaf_border.h"
#include "stream/triangulate/merge_tree.h"
#include "stream/triangulate/tuning.h"

namespace spillway::stream {
namespace {

constexpr std::size_t kGrain = 4096;

/// A merge may ask for points in so many steps for each simplex, or each point below it.
constexpr std::size_t kStepsOfOne = 64;

template <int D>
void count_settled(const Settled<D>& settled, StreamCounts& counts) {
  counts.hull_facets += settled.hull_facets;
  counts.left_out += settled.left_out;
  counts.add(settled.torus);
  counts.borders.add(settled.border.simplices.size(), settled.border.bytes());
}

/// Passes on what is final, and returns the border.
template <int D>
Border<D> submit(Settled<D> settled, BlockPlace block, Sequencer<D>& sequencer) {
  sequencer.submit(block, std::move(settled.mesh), std::move(settled.imported), settled.hash);
  return std::move(settled.border);
}

/// The same, and counts what has been settled.
template <int D>
Border<D> pass_on(const TileContext<D>& context, Settled<D> settled, BlockPlace block) {
  count_settled(settled, context.counts);
  return submit(std::move(settled), block, context.sequencer);
}

/// An open border goes up as it is; the stream's block of that number stays empty.
template <int D>
Border<D> pass_up(const TileContext<D>& context, Border<D> border, BlockPlace block) {
  context.sequencer.submit(block, {}, {}, {});
  context.counts.borders.add(0, border.bytes());
  return border;
}

/// merge_borders() of borders that are counted as resident; its result is not yet.
template <int D, PointTree Tree>
MergedBorder<D> merge_resident(const TileContext<D>& context, std::span<Border<D>> children,
                               const Tree& node, Task& task) {
  std::uint64_t simplices = 0;
  std::uint64_t bytes = 0;
  for (const Border<D>& child : children) {
    simplices += child.simplices.size();
    bytes += child.bytes();
  }
  std::vector<const Tree*> of_children;
  for (const Tree& tree : node.children) of_children.push_back(&tree);
  context.budget.give_back_freed();
  const StageTimer timer(context.counts.times, Stage::kMerge);
  MergedBorder<D> merged =
      merge_borders<D, Tree>(children, of_children, context.budget, task, context.asked.kernel);
  context.counts.borders.remove(simplices, bytes);
  context.counts.retriangulated += merged.retriangulated;
  return merged;
}

/// The lease of a leaf, or of a merge inside of a tile. When it has grown, the memory that base
/// cases keep goes at its end: of what is more than leaves of `leaf_points` points need.
template <int D>
class WorkingMemory {
 public:
  WorkingMemory(WorkLease lease, std::size_t leaf_points)
      : lease_(std::move(lease)), leaf_points_(leaf_points) {}
  ~WorkingMemory() { give_back(); }
  WorkingMemory(const WorkingMemory&) = delete;
  WorkingMemory& operator=(const WorkingMemory&) = delete;

  void give_back() {
    if (lease_.grown()) release_base_case_memory_above<D>(leaf_points_);
    lease_ = {};
  }

  [[nodiscard]] WorkLease& lease() { return lease_; }

 private:
  WorkLease lease_;
  std::size_t leaf_points_;
};

/// Which simplices of a merged border are final: nothing around it may change them. There are so
/// many points below the merge.
template <int D>
Settled<D> settle_merged(MergedBorder<D>& merged, BlockPlace block, const OutputOptions& output,
                         const Surroundings<D>& surroundings, std::uint64_t points,
                         StageTimes& times) {
  const StageTimer timer(times, Stage::kFinality);
  Border<D>& border = merged.border;
  const std::vector<Point<D>> positions = border.positions();
  std::vector<Fate> fates(border.simplices.size(), Fate::kKept);
  const bool tells_exposure = surroundings.tells_exposure() && merged.exposure_is_known;
  std::vector<Exposure>& exposure = border.exposure;
  if (tells_exposure) {
    exposure.resize(fates.size());
  } else {
    exposure = {};
  }
  const std::span<const std::array<VertexId, D + 1>> fresh =
      std::span(border.simplices).subspan(merged.tested);
  const std::size_t grains = std::max<std::size_t>(1, grain_count(fresh.size(), kGrain));
  parallel_for(fresh.size(), kGrain, [&](std::size_t, std::size_t begin, std::size_t end) {
    ChangeSearch<D> search(surroundings,
                           kStepsOfOne * std::max<std::size_t>(end - begin, points / grains));
    for_each_region_batch<D>(
        end - begin, [&](std::size_t s) { return fresh[begin + s]; }, positions,
        [&](std::size_t first, const ConflictRegionBatch<D>& regions) {
          const std::size_t at = merged.tested + begin + first;
          const std::uint64_t changed =
              search.may_change(regions, tells_exposure ? &exposure[at] : nullptr);
          tell_fates(regions, changed, [&](std::size_t s, Fate fate) { fates[at + s] = fate; });
        });
  });
  return settle<D>(
      MergeToSettle<D>{.block = block, .merged = border, .fates = fates, .exposure = exposure},
      output);
}

/// Cuts `cell` back so that it has nothing in common with any leaf of `tree`. Boxes of nodes may
/// overlap with `box`, though those of leaves as a rule do not.
template <int D, PointTree Tree>
void cut_back_from(Box<D>& cell, const Box<D>& box, const Tree& tree) {
  if (common_part(box, tree.box).empty()) {
    cut_back(cell, box, tree.box);
  } else if (tree.leaf()) {
    cell = {};
  } else {
    for (const Tree& child : tree.children) cut_back_from(cell, box, child);
  }
}

template <int D>
class TileRun {
 public:
  TileRun(const TileContext<D>& context, TileInput<D> tile)
      : context_(context),
        counts_(context.counts),
        tile_(std::move(tile.points)),
        outside_(tile.outside),
        slot_(tile.slot) {}

  Border<D> run(Task& task) {
    std::vector<Task> division(1);
    input_index_.resize(tile_.points.size());
    std::iota(input_index_.begin(), input_index_.end(), VertexId{0});
    {
      const StageTimer timer(counts_.times, Stage::kDivide);
      root_ = divide<D>(tile_.points, input_index_,
                        {.leaf_points = context_.leaf_points,
                         .scheme = context_.asked.division,
                         .children = context_.asked.children,
                         .stop = {},
                         .fill_leaves = true,
                         .smallest_judged = TileTuning<D>::kSmallestJudged,
                         .largest_undivided = largest_undivided<D>(context_.budget.limit(),
                                                                   context_.output.record_size)},
                        division.data());
    }
    counts_.points += tile_.left_out;
    counts_.duplicates += tile_.left_out;
    context_.sequencer.open_slot(slot_, root_.list + 1);
    tree_.emplace(root_);
    const std::vector<Node*>& leaves = tree_->leaves();
    judge_leaves();
    parallel_for(leaves.size(), 1, [&](std::size_t, std::size_t begin, std::size_t) {
      Node& leaf = *leaves[begin];
      leaf.border = triangulate_leaf(leaf);
      if (context_.progress) context_.progress();
      tree_->leaf_done(leaf, [this](Node& node) { node.border = merge_node(node); });
    });
    task = task_tree();
    task.before = std::move(division);
    return std::move(tree_->root().border);
  }

 private:
  struct State {
    Border<D> border;     ///< once the node is done
    Task task;            ///< likewise, without those of its children
    bool hollow = false;  ///< a part of it is a curve or a surface
  };
  using Tree = MergeTree<Part<D>, State>;
  using Node = typename Tree::Node;

  [[nodiscard]] std::span<const Point<D>> points_of(const Part<D>& part) const {
    return std::span<const Point<D>>(tile_.points).subspan(part.begin, part.size());
  }

  /// Tells which leaves are hollow; if any is, their points will be asked for.
  void judge_leaves() {
    const std::vector<Node*>& leaves = tree_->leaves();
    parallel_for(leaves.size(), 1, [&](std::size_t, std::size_t l, std::size_t) {
      leaves[l]->hollow = is_hollow<D>(points_of(*leaves[l]->tree), leaves[l]->tree->box);
    });
    if (std::ranges::none_of(leaves, [](const Node* leaf) { return leaf->hollow; })) return;
    boxes_.resize(root_.list + 1);
    parallel_for(leaves.size(), 1, [&](std::size_t, std::size_t l, std::size_t) {
      boxes_[leaves[l]->tree->list] = RunBoxes<D>(points_of(*leaves[l]->tree));
    });
  }

  /// Puts the tasks of all nodes together.
  Task task_tree() {
    for (Node& node : tree_->nodes()) {
      node.task.kind = node.children.empty() ? TaskKind::kBaseCase : TaskKind::kNode;
      node.task.points = node.tree->size();
      for (Node* child : node.children) node.task.children.push_back(std::move(child->task));
    }
    return std::move(tree_->root().task);
  }

  [[nodiscard]] Surroundings<D> surroundings_of(const Node& node) const {
    return {tree_->siblings_by_level(node), outside_, tile_.points, boxes_, node.hollow};
  }

  Border<D> triangulate_leaf(Node& node) {
    const Stopwatch watch(node.task.seconds);
    context_.budget.give_back_freed();
    const Part<D>& part = *node.tree;
    const auto points = points_of(part);
    WorkingMemory<D> memory(
        WorkLease(context_.budget,
                  part.size() * (TileTuning<D>::kLeafBytes + context_.output.record_size),
                  "the triangulation of a leaf"),
        context_.leaf_points);
    BaseCase<D> leaf = base_case(node, points, memory.lease());
    counts_.points += part.size();
    counts_.duplicates += leaf.duplicates.size();
    ++counts_.leaves;
    raise(counts_.densest_leaf, leaf.corners.size() / part.size() + 1);
    if constexpr (D == 2) {
      choose_heights(leaf.duplicates, context_.asked.heights, input_index_, tile_.heights,
                     tile_.index);
    } else {
      keep_first(leaf.duplicates, input_index_, tile_.index);
    }
    if (leaf.dimension < D) {
      memory.give_back();
      return pass_up(context_, open_border(part, leaf), place_of(node));
    }
    Settled<D> settled = settle_leaf(node, leaf);
    recycle(std::move(leaf));
    memory.give_back();
    counts_.final_in_leaves += settled.final_simplices;
    return pass_on(context_, std::move(settled), place_of(node));
  }

  Settled<D> settle_leaf(const Node& node, BaseCase<D>& base_case) {
    const StageTimer timer(counts_.times, Stage::kFinality);
    LeafToSettle<D> leaf = leaf_of(*node.tree);
    LeafFates told;
    if (node.hollow) {
      told = search_leaf_border<D>({leaf.points, leaf.first_vertex, node.tree->box},
                                   surroundings_of(node), base_case);
    }
    leaf.corners = base_case.corners.span();
    leaf.duplicates = base_case.duplicates;
    leaf.open = *base_case.not_inside;
    leaf.open_simplices = base_case.open_simplices;
    if (!node.hollow) told = test_leaf_border<D>(leaf, surroundings_of(node));
    leaf.fates = told.fates;
    leaf.exposure = told.exposure;
    return settle<D>(leaf, context_.output);
  }

  /// Of a leaf that is not hollow its corners, and of a hollow one its simplices.
  BaseCase<D> base_case(const Node& node, std::span<const Point<D>> points, WorkLease& memory) {
    const StageTimer timer(counts_.times, Stage::kLeaves);
    const Part<D>& part = *node.tree;
    BaseCaseInput<D> input{.points = points,
                           .input_index = std::span(input_index_).subspan(part.begin, part.size()),
                           .first_vertex = part.begin,
                           .in_place = true,
                           .kernel = context_.asked.kernel,
                           .memory = &memory};
    input.safe_box = safe_box_of(node);
    input.corners_only = !node.hollow;
    return triangulate_base_case<D>(input);
  }

  /// The box around a leaf that has nothing in common with the box of any other part.
  [[nodiscard]] Box<D> safe_box_of(const Node& node) const {
    Box<D> safe_box = whole_space<D>();
    for (const Part<D>* part : tree_->siblings_up(node)) {
      cut_back_from(safe_box, node.tree->box, *part);
    }
    for (const TileNode<D>* tile : outside_) cut_back_from(safe_box, node.tree->box, *tile);
    return safe_box;
  }

  /// What can be settled of a leaf, but for its simplices.
  [[nodiscard]] LeafToSettle<D> leaf_of(const Part<D>& part) const {
    LeafToSettle<D> leaf;
    leaf.block = {slot_, part.list};
    leaf.first_vertex = part.begin;
    leaf.points = points_of(part);
    leaf.input_index = std::span(input_index_).subspan(part.begin, part.size());
    if constexpr (D == 2) leaf.heights = tile_.heights;
    leaf.index = tile_.index;
    leaf.attributes = tile_.attributes;
    return leaf;
  }

  /// A leaf without simplices: all its distinct points.
  [[nodiscard]] Border<D> open_border(const Part<D>& part, const BaseCase<D>& base_case) const {
    const LeafToSettle<D> leaf = leaf_of(part);
    const std::size_t record_size = context_.output.record_size;
    Border<D> border;
    border.dimension = base_case.dimension;
    auto duplicate = base_case.duplicates.begin();
    for (VertexId v = 0; v < part.size(); ++v) {
      if (duplicate != base_case.duplicates.end() && duplicate->dropped == part.begin + v) {
        ++duplicate;
      } else {
        border.vertices.push_back(leaf.vertex(v));
        if (record_size == 0) continue;
        const std::byte* const record = leaf.record(v, record_size);
        border.attributes.insert(border.attributes.end(), record, record + record_size);
      }
    }
    return border;
  }

  Border<D> merge_node(Node& node) {
    std::vector<Border<D>> children;
    for (Node* child : node.children) {
      children.push_back(std::exchange(child->border, {}));
      node.hollow = node.hollow || child->hollow;
    }
    MergedBorder<D> merged = merge_resident<D>(context_, children, *node.tree, node.task);
    WorkingMemory<D> memory(std::move(merged.memory), context_.leaf_points);
    const BlockPlace block = place_of(node);
    if (merged.border.open()) {
      memory.give_back();
      return pass_up(context_, std::move(merged.border), block);
    }
    Settled<D> settled = settle_merged(merged, block, context_.output, surroundings_of(node),
                                       node.tree->size(), counts_.times);
    memory.give_back();
    counts_.final_in_tiles += settled.final_simplices;
    return pass_on(context_, std::move(settled), block);
  }

  [[nodiscard]] BlockPlace place_of(const Node& node) const { return {slot_, node.number}; }

  const TileContext<D>& context_;
  StreamCounts& counts_;
  TilePoints<D> tile_;
  std::vector<VertexId> input_index_;
  const Outside<D>& outside_;
  const std::uint32_t slot_;
  Part<D> root_;
  std::vector<RunBoxes<D>> boxes_;  ///< of leaves, by list, if one is hollow
  std::optional<Tree> tree_;
};

}  // namespace

template <int D>
std::size_t largest_undivided(std::uint64_t limit, std::size_t record_size) {
  constexpr std::uint64_t kShare = 4;
  return limit / kShare / (TileTuning<D>::kLeafBytes + record_size);
}

template <int D>
Border<D> triangulate_tile(const TileContext<D>& context, TileInput<D> tile, Task& task) {
  return TileRun<D>(context, std::move(tile)).run(task);
}

template <int D>
MergedTiles<D> merge_tiles(const TileContext<D>& context, const MergeInput<D>& input, Task& task) {
  context.sequencer.open_slot(input.place.slot, 1);
  MergedBorder<D> merged = merge_resident<D>(context, input.children, input.node, task);
  if (input.outside_shrank) merged.tested = 0;
  // The largest merges are more than leaves.
  release_base_case_memory_above<D>(context.leaf_points);
  context.budget.give_back_freed();
  Settled<D> settled;
  if (merged.border.open()) {
    settled.border = std::move(merged.border);
  } else {
    settled = settle_merged<D>(merged, input.place, context.output,
                               {.levels = {}, .outside = input.outside}, 0, context.counts.times);
  }
  merged.memory = {};
  const std::uint64_t final_simplices = settled.final_simplices;
  return {pass_on(context, std::move(settled), input.place), final_simplices};
}

#define SPILLWAY_INSTANTIATE(D)                                                    \
  template std::size_t largest_undivided<D>(std::uint64_t, std::size_t);           \
  template Border<D> triangulate_tile(const TileContext<D>&, TileInput<D>, Task&); \
  template MergedTiles<D> merge_tiles(const TileContext<D>&, const MergeInput<D>&, Task&);
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::stream
