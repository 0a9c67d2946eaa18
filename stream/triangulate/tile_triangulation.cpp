#include "stream/triangulate/tile_triangulation.h"

#include <algorithm>
#include <array>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>

#include "src/delaunay/base_case.h"
#include "src/delaunay/finality.h"
#include "src/parallel/parallel.h"

namespace spillway::detail {
namespace {

constexpr std::size_t kGrain = 4096;

template <int D>
void count_settled(const Settled<D>& settled, StreamCounts& counts) {
  counts.hull_facets += settled.hull_facets;
  counts.left_out += settled.left_out;
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
Border<D> pass_on(Settled<D> settled, BlockPlace block, Sequencer<D>& sequencer,
                  StreamCounts& counts) {
  count_settled(settled, counts);
  return submit(std::move(settled), block, sequencer);
}

/// merge_borders() of borders that are counted as resident; its result is not yet.
template <int D, typename Tree>
MergedBorder<D> merge_resident(std::span<Border<D>> children, const std::vector<const Tree*>& trees,
                               MemoryBudget& budget, StreamCounts& counts, Task& task) {
  std::uint64_t simplices = 0;
  std::uint64_t bytes = 0;
  for (const Border<D>& child : children) {
    simplices += child.simplices.size();
    bytes += child.bytes();
  }
  const StageTimer timer(counts.times, Stage::kMerge);
  MergedBorder<D> merged =
      merge_borders<D, Tree>(children, std::span<const Tree* const>(trees), budget, task);
  counts.borders.remove(simplices, bytes);
  counts.retriangulated += merged.retriangulated;
  return merged;
}

/// An open border goes up as it is; the stream's block of that number stays empty.
template <int D>
Border<D> pass_up(Border<D> border, BlockPlace block, Sequencer<D>& sequencer,
                  StreamCounts& counts) {
  sequencer.submit(block, {}, {}, {});
  counts.borders.add(0, border.bytes());
  return border;
}

template <int D>
Fate final_fate(const ConflictRegion<D>& region) {
  return region.infinite() ? Fate::kFinalFacet : Fate::kFinal;
}

/// Which simplices of a merged border are final: nothing of `trees` may change them.
template <int D, typename MayBeChanged>
Settled<D> settle_merged(const MergedBorder<D>& merged, BlockPlace block,
                         const OutputOptions& output, const MayBeChanged& may_be_changed,
                         StageTimes& times) {
  const StageTimer timer(times, Stage::kFinality);
  const Border<D>& border = merged.border;
  const std::vector<Point<D>> positions = border.positions();
  std::vector<Fate> fates(border.simplices.size(), Fate::kKept);
  parallel_for(
      fates.size() - merged.tested, kGrain, [&](std::size_t, std::size_t begin, std::size_t end) {
        const std::size_t first = merged.tested + begin;
        for_each_region<D>(
            end - begin, [&](std::size_t s) { return border.simplices[first + s]; }, positions,
            [&](std::size_t s, const ConflictRegion<D>& region) {
              if (!may_be_changed(region)) fates[first + s] = final_fate(region);
            });
      });
  return settle<D>(MergeToSettle<D>{.block = block, .merged = border, .fates = fates}, output);
}

template <int D>
class TileRun {
 public:
  TileRun(TilePoints<D> tile, const Outside<D>& outside, const TileOptions& options,
          Sequencer<D>& sequencer, StreamCounts& counts, std::uint32_t slot,
          const std::function<void()>& progress)
      : tile_(std::move(tile)),
        outside_(outside),
        options_(options),
        sequencer_(sequencer),
        counts_(counts),
        slot_(slot),
        progress_(progress) {}

  Border<D> run(Task& task) {
    task.points = tile_.points.size();
    task.before.resize(1);
    input_index_.resize(tile_.points.size());
    std::iota(input_index_.begin(), input_index_.end(), VertexId{0});
    {
      const StageTimer timer(counts_.times, Stage::kDivide);
      root_ =
          divide<D>(tile_.points, input_index_,
                    {options_.leaf_size, options_.division, options_.children}, task.before.data());
    }
    sequencer_.open_slot(slot_, root_.block + 1);
    nodes_.resize(root_.block + 1);
    add_node(root_, kNoParent, 0, task);
    parallel_for(leaves_.size(), 1, [&](std::size_t, std::size_t begin, std::size_t) {
      work_from_leaf(leaves_[begin]);
    });
    return std::move(nodes_[root_.block].border);
  }

 private:
  static constexpr std::uint32_t kNoParent = ~std::uint32_t{0};

  /// A part of the tile, by its block number.
  struct Node {
    const Part<D>* part = nullptr;
    std::uint32_t parent = kNoParent;
    std::size_t place = 0;  ///< among its parent's children
    Task* task = nullptr;
    std::unique_ptr<std::atomic<std::size_t>> children_missing;
    Border<D> border;
  };

  void add_node(const Part<D>& part, std::uint32_t parent, std::size_t place, Task& task) {
    Node& node = nodes_[part.block];
    node.part = &part;
    node.parent = parent;
    node.place = place;
    node.task = &task;
    task.points = part.size();
    task.kind = part.leaf() ? "base_case" : "node";
    if (part.leaf()) {
      leaves_.push_back(part.block);
      return;
    }
    node.children_missing = std::make_unique<std::atomic<std::size_t>>(part.children.size());
    task.children.resize(part.children.size());
    for (std::size_t c = 0; c < part.children.size(); ++c) {
      add_node(part.children[c], part.block, c, task.children[c]);
    }
  }

  /// Does a leaf, and all nodes above whose last child is done thereby.
  void work_from_leaf(std::uint32_t leaf) {
    nodes_[leaf].border = triangulate_leaf(nodes_[leaf]);
    if (progress_) progress_();
    std::uint32_t above = nodes_[leaf].parent;
    while (above != kNoParent && --*nodes_[above].children_missing == 0) {
      nodes_[above].border = merge_node(nodes_[above]);
      above = nodes_[above].parent;
    }
  }

  [[nodiscard]] std::vector<const Part<D>*> siblings_up(const Node& node) const {
    std::vector<const Part<D>*> siblings;
    for (const Node* n = &node; n->parent != kNoParent; n = &nodes_[n->parent]) {
      const auto& children = nodes_[n->parent].part->children;
      for (std::size_t c = 0; c < children.size(); ++c) {
        if (c != n->place) siblings.push_back(&children[c]);
      }
    }
    return siblings;
  }

  [[nodiscard]] auto change_test(std::vector<const Part<D>*> siblings) const {
    return [this, siblings = std::move(siblings)](const ConflictRegion<D>& region) {
      return std::any_of(siblings.begin(), siblings.end(),
                         [&](const Part<D>* part) { return region.may_meet_leaf(*part); }) ||
             std::any_of(outside_.begin(), outside_.end(),
                         [&](const TileNode<D>* tile) { return region.may_meet_leaf(*tile); });
    };
  }

  Border<D> triangulate_leaf(const Node& node) {
    const Stopwatch watch(node.task->seconds);
    const Part<D>& part = *node.part;
    const auto points = std::span(tile_.points).subspan(part.begin, part.size());
    BaseCase<D> leaf = base_case(node, points);
    counts_.points += part.size();
    counts_.duplicates += leaf.duplicates.size();
    ++counts_.leaves;
    if constexpr (D == 2) {
      choose_heights(leaf.duplicates, options_.heights, input_index_, tile_.heights, tile_.index);
    } else {
      keep_first(leaf.duplicates, input_index_, tile_.index);
    }
    if (leaf.dimension < D) {
      return pass_up(open_border(part, leaf), BlockPlace{slot_, part.block}, sequencer_, counts_);
    }
    Settled<D> settled = settle_leaf(node, leaf);
    recycle(std::move(leaf.simplices));
    counts_.final_in_leaves += settled.final_simplices;
    return pass_on(std::move(settled), BlockPlace{slot_, part.block}, sequencer_, counts_);
  }

  Settled<D> settle_leaf(const Node& node, const BaseCase<D>& base_case) {
    const StageTimer timer(counts_.times, Stage::kFinality);
    LeafToSettle<D> leaf = leaf_of(*node.part);
    leaf.simplices = {base_case.simplices.data(), base_case.simplices.size()};
    const std::vector<Fate> fates = fates_in_leaf(node, leaf, base_case.not_inside);
    leaf.fates = fates;
    return settle<D>(leaf, options_.output);
  }

  BaseCase<D> base_case(const Node& node, std::span<const Point<D>> points) {
    const StageTimer timer(counts_.times, Stage::kLeaves);
    const Part<D>& part = *node.part;
    return triangulate_base_case<D>(
        {.points = points,
         .input_index = std::span(input_index_).subspan(part.begin, part.size()),
         .first_vertex = part.begin,
         .region = cell_of(node),
         .in_place = true});
  }

  /// The box around a leaf that has nothing in common with the box of any other part.
  [[nodiscard]] Box<D> cell_of(const Node& node) const {
    Box<D> cell = whole_space<D>();
    for (const Part<D>* part : siblings_up(node)) cut_back(cell, node.part->box, part->box);
    for (const TileNode<D>* tile : outside_) cut_back(cell, node.part->box, tile->box);
    return cell;
  }

  /// What can be settled of a leaf, but for its simplices.
  [[nodiscard]] LeafToSettle<D> leaf_of(const Part<D>& part) const {
    LeafToSettle<D> leaf;
    leaf.block = {slot_, part.block};
    leaf.first_vertex = part.begin;
    leaf.points = std::span(tile_.points).subspan(part.begin, part.size());
    leaf.input_index = std::span(input_index_).subspan(part.begin, part.size());
    if constexpr (D == 2) leaf.heights = tile_.heights;
    leaf.index = tile_.index;
    return leaf;
  }

  /// A leaf without simplices: all its distinct points.
  [[nodiscard]] Border<D> open_border(const Part<D>& part, const BaseCase<D>& base_case) const {
    const LeafToSettle<D> leaf = leaf_of(part);
    Border<D> border;
    border.dimension = base_case.dimension;
    auto duplicate = base_case.duplicates.begin();
    for (VertexId v = 0; v < part.size(); ++v) {
      if (duplicate != base_case.duplicates.end() && duplicate->dropped == part.begin + v) {
        ++duplicate;
      } else {
        border.vertices.push_back(leaf.vertex(v));
      }
    }
    return border;
  }

  /// The simplices of a leaf whose circumspheres are not known to lie in its cell, if the kernel
  /// has not told: infinite ones, those near the cell's sides, and some that are flat.
  [[nodiscard]] std::vector<std::uint32_t> open_questions(const Node& node,
                                                          const LeafToSettle<D>& leaf) const {
    std::vector<std::uint32_t> open;
    const Box<D> cell = cell_of(node);
    SimplexBatch<D> batch{};
    const auto count = static_cast<std::uint32_t>(leaf.simplex_count());
    for (std::uint32_t begin = 0; begin < count; begin += batch.kSize) {
      const std::uint32_t end = std::min<std::uint32_t>(begin + batch.kSize, count);
      for (std::uint32_t s = begin; s < end; ++s) {
        // An infinite one becomes a point, of which the test of a batch knows nothing.
        const bool infinite = leaf.simplices[s].infinite();
        const std::array<VertexId, D + 1> corners = leaf.finite_simplex(s);
        batch.set(s - begin, [&](int i) { return leaf.points[infinite ? 0 : corners[i]]; });
      }
      const auto found = well_inside<D>(batch, cell);
      for (std::uint32_t s = begin; s < end; ++s) {
        if (!found[s - begin]) open.push_back(s);
      }
    }
    return open;
  }

  /// `not_inside` is that of the leaf's base case.
  [[nodiscard]] std::vector<Fate> fates_in_leaf(
      const Node& node, const LeafToSettle<D>& leaf,
      const std::optional<std::vector<std::uint32_t>>& not_inside) const {
    const auto may_be_changed = change_test(siblings_up(node));
    std::vector<std::uint32_t> asked;
    if (!not_inside) asked = open_questions(node, leaf);
    const std::span<const std::uint32_t> open = not_inside ? *not_inside : asked;
    std::vector<Fate> fates(leaf.simplex_count(), Fate::kFinal);
    for_each_region<D>(
        open.size(), [&](std::size_t i) { return leaf.simplex(open[i]); }, leaf.points,
        [&](std::size_t i, const ConflictRegion<D>& region) {
          fates[open[i]] = may_be_changed(region) ? Fate::kKept : final_fate(region);
        });
    return fates;
  }

  Border<D> merge_node(const Node& node) {
    const Part<D>& part = *node.part;
    std::vector<Border<D>> children;
    std::vector<const Part<D>*> trees;
    for (const Part<D>& child : part.children) {
      children.push_back(std::exchange(nodes_[child.block].border, {}));
      trees.push_back(&child);
    }
    MergedBorder<D> merged = merge_resident(std::span<Border<D>>(children), trees, *options_.budget,
                                            counts_, *node.task);
    const BlockPlace block{slot_, part.block};
    if (merged.border.open()) {
      return pass_up(std::move(merged.border), block, sequencer_, counts_);
    }
    Settled<D> settled = settle_merged(merged, block, options_.output,
                                       change_test(siblings_up(node)), counts_.times);
    counts_.final_in_tiles += settled.final_simplices;
    return pass_on(std::move(settled), block, sequencer_, counts_);
  }

  TilePoints<D> tile_;
  std::vector<VertexId> input_index_;
  const Outside<D>& outside_;
  const TileOptions& options_;
  Sequencer<D>& sequencer_;
  StreamCounts& counts_;
  const std::uint32_t slot_;
  const std::function<void()>& progress_;
  Part<D> root_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> leaves_;
};

}  // namespace

template <int D>
Border<D> triangulate_tile(TilePoints<D> tile, const Outside<D>& outside,
                           const TileOptions& options, Sequencer<D>& sequencer,
                           StreamCounts& counts, std::uint32_t slot,
                           const std::function<void()>& progress, Task& task) {
  return TileRun<D>(std::move(tile), outside, options, sequencer, counts, slot, progress).run(task);
}

template <int D>
Settled<D> merge_borders_of(std::span<Border<D>> children, const TileNode<D>& node,
                            const Outside<D>& outside, const TileOptions& options,
                            StreamCounts& counts, BlockPlace place, Task& task) {
  std::vector<const TileNode<D>*> trees;
  for (const TileNode<D>& child : node.children) trees.push_back(&child);
  MergedBorder<D> merged = merge_resident(children, trees, *options.budget, counts, task);
  Settled<D> settled;
  if (merged.border.open()) {
    settled.border = std::move(merged.border);
  } else {
    const auto may_be_changed = [&](const ConflictRegion<D>& region) {
      return std::any_of(outside.begin(), outside.end(),
                         [&](const TileNode<D>* tile) { return region.may_meet_leaf(*tile); });
    };
    settled = settle_merged(merged, place, options.output, may_be_changed, counts.times);
  }
  count_settled(settled, counts);
  return settled;
}

template <int D>
Border<D> merge_tiles(std::span<Border<D>> children, const TileNode<D>& node,
                      const Outside<D>& outside, const TileOptions& options,
                      Sequencer<D>& sequencer, StreamCounts& counts, std::uint32_t slot,
                      std::uint64_t& final_simplices, Task& task) {
  const BlockPlace place{slot, 0};
  sequencer.open_slot(slot, 1);
  Settled<D> settled = merge_borders_of(children, node, outside, options, counts, place, task);
  final_simplices += settled.final_simplices;
  return submit(std::move(settled), place, sequencer);
}

template Border<2> triangulate_tile(TilePoints<2>, const Outside<2>&, const TileOptions&,
                                    Sequencer<2>&, StreamCounts&, std::uint32_t,
                                    const std::function<void()>&, Task&);
template Border<3> triangulate_tile(TilePoints<3>, const Outside<3>&, const TileOptions&,
                                    Sequencer<3>&, StreamCounts&, std::uint32_t,
                                    const std::function<void()>&, Task&);
template Settled<2> merge_borders_of(std::span<Border<2>>, const TileNode<2>&, const Outside<2>&,
                                     const TileOptions&, StreamCounts&, BlockPlace, Task&);
template Settled<3> merge_borders_of(std::span<Border<3>>, const TileNode<3>&, const Outside<3>&,
                                     const TileOptions&, StreamCounts&, BlockPlace, Task&);
template Border<2> merge_tiles(std::span<Border<2>>, const TileNode<2>&, const Outside<2>&,
                               const TileOptions&, Sequencer<2>&, StreamCounts&, std::uint32_t,
                               std::uint64_t&, Task&);
template Border<3> merge_tiles(std::span<Border<3>>, const TileNode<3>&, const Outside<3>&,
                               const TileOptions&, Sequencer<3>&, StreamCounts&, std::uint32_t,
                               std::uint64_t&, Task&);

}  // namespace spillway::detail
