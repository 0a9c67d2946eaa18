#include "stream/tile_triangulation.h"

#include <algorithm>
#include <array>
#include <memory>
#include <numeric>
#include <utility>

#include "src/delaunay/base_case.h"
#include "src/delaunay/finality.h"
#include "src/parallel/parallel.h"

namespace spillway {
namespace {

constexpr std::size_t kGrain = 4096;

/// Cuts `cell` back so that it has nothing in common with `other`, which lies apart from `box` on
/// some axis, as the boxes of a division do.
template <int D>
void cut_back(Box<D>& cell, const Box<D>& box, const Box<D>& other) {
  for (int k = 0; k < D; ++k) {
    if (other.lo[k] > box.hi[k]) {
      cell.hi[k] = std::min(cell.hi[k], other.lo[k]);
      return;
    }
    if (other.hi[k] < box.lo[k]) {
      cell.lo[k] = std::max(cell.lo[k], other.hi[k]);
      return;
    }
  }
}

template <int D>
Box<D> whole_space() {
  Box<D> box;
  std::swap(box.lo, box.hi);
  return box;
}

/// Counts what has been settled, passes on what is final, and returns the border.
template <int D>
Border<D> pass_on(Settled<D> settled, BlockPlace block, Sequencer<D>& sequencer,
                  StreamCounts& counts) {
  counts.hull_facets += settled.hull_facets;
  counts.left_out += settled.left_out;
  sequencer.submit(block, std::move(settled.mesh), std::move(settled.imported), settled.hash);
  counts.borders.add(settled.border.simplices.size(), settled.border.bytes());
  return std::move(settled.border);
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

/// Which simplices of a merged border are final: nothing of `trees` may change them.
template <int D, typename MayBeChanged>
Settled<D> settle_merged(const MergedBorder<D>& merged, BlockPlace block,
                         const OutputOptions& output, const MayBeChanged& may_be_changed,
                         StageTimes& times) {
  const StageTimer timer(times, Stage::kFinality);
  const Border<D>& border = merged.border;
  std::vector<Point<D>> positions(border.vertices.size());
  for (std::size_t v = 0; v < positions.size(); ++v) positions[v] = border.vertices[v].position;
  std::vector<std::uint8_t> is_final(border.simplices.size());
  parallel_for(is_final.size() - merged.tested, kGrain,
               [&](std::size_t, std::size_t begin, std::size_t end) {
                 for (std::size_t s = merged.tested + begin; s < merged.tested + end; ++s) {
                   const ConflictRegion<D> region(border.simplices[s], positions);
                   is_final[s] = may_be_changed(region) ? 0 : 1;
                 }
               });
  return settle<D>({.dimension = border.dimension,
                    .block = block,
                    .simplices = border.simplices,
                    .is_final = is_final,
                    .vertices = border.vertices},
                   output);
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
    BaseCase<D> leaf = base_case(part, points);
    counts_.points += part.size();
    counts_.duplicates += leaf.duplicates.size();
    ++counts_.leaves;
    if constexpr (D == 2) {
      choose_heights(leaf.duplicates, options_.heights, input_index_, tile_.heights);
    }
    if (leaf.dimension < D) {
      return pass_up(open_border(part, leaf), BlockPlace{slot_, part.block}, sequencer_, counts_);
    }
    Settled<D> settled = settle_leaf(node, std::move(leaf.simplices), points);
    counts_.final_in_leaves += settled.final_simplices;
    return pass_on(std::move(settled), BlockPlace{slot_, part.block}, sequencer_, counts_);
  }

  Settled<D> settle_leaf(const Node& node, std::vector<Simplex<D>> leaf,
                         std::span<const Point<D>> points) {
    const StageTimer timer(counts_.times, Stage::kFinality);
    std::vector<std::array<VertexId, D + 1>> simplices(leaf.size());
    for (std::size_t s = 0; s < simplices.size(); ++s) {
      simplices[s] = leaf[s].vertices;
      for (VertexId& v : simplices[s]) {
        if (v != kInfiniteVertex) v -= node.part->begin;
      }
    }
    leaf = {};
    return settle<D>({.dimension = D,
                      .block = {slot_, node.part->block},
                      .simplices = simplices,
                      .is_final = final_in_leaf(node, points, simplices),
                      .vertices = leaf_vertices(*node.part)},
                     options_.output);
  }

  BaseCase<D> base_case(const Part<D>& part, std::span<const Point<D>> points) {
    const StageTimer timer(counts_.times, Stage::kLeaves);
    return triangulate_base_case<D>(
        {.points = points,
         .input_index = std::span(input_index_).subspan(part.begin, part.size()),
         .first_vertex = part.begin});
  }

  [[nodiscard]] std::vector<BorderVertex<D>> leaf_vertices(const Part<D>& part) const {
    std::vector<BorderVertex<D>> vertices(part.size());
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      vertices[v].position = tile_.points[part.begin + v];
      const VertexId input = input_index_[part.begin + v];
      if constexpr (D == 2) vertices[v].height = tile_.heights[input];
      if (!tile_.index.empty()) vertices[v].input_index = tile_.index[input];
    }
    return vertices;
  }

  /// A leaf without simplices: all its distinct points.
  [[nodiscard]] Border<D> open_border(const Part<D>& part, const BaseCase<D>& leaf) const {
    const std::vector<BorderVertex<D>> vertices = leaf_vertices(part);
    Border<D> border;
    border.dimension = leaf.dimension;
    auto duplicate = leaf.duplicates.begin();
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      if (duplicate != leaf.duplicates.end() && duplicate->dropped == part.begin + v) {
        ++duplicate;
      } else {
        border.vertices.push_back(vertices[v]);
      }
    }
    return border;
  }

  [[nodiscard]] std::vector<std::uint8_t> final_in_leaf(
      const Node& node, std::span<const Point<D>> points,
      const std::vector<std::array<VertexId, D + 1>>& simplices) const {
    std::vector<const Part<D>*> siblings = siblings_up(node);
    Box<D> cell = whole_space<D>();
    for (const Part<D>* part : siblings) cut_back(cell, node.part->box, part->box);
    for (const TileNode<D>* tile : outside_) cut_back(cell, node.part->box, tile->box);
    const auto may_be_changed = change_test(std::move(siblings));
    std::vector<std::uint8_t> is_final(simplices.size());
    for (std::size_t s = 0; s < simplices.size(); ++s) {
      const ConflictRegion<D> region(simplices[s], points);
      is_final[s] = region.inside(cell) || !may_be_changed(region) ? 1 : 0;
    }
    return is_final;
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
Border<D> merge_tiles(std::span<Border<D>> children, const TileNode<D>& node,
                      const Outside<D>& outside, const TileOptions& options,
                      Sequencer<D>& sequencer, StreamCounts& counts, std::uint32_t slot,
                      std::uint64_t& final_simplices, Task& task) {
  const BlockPlace block{slot, 0};
  sequencer.open_slot(slot, 1);
  std::vector<const TileNode<D>*> trees;
  for (const TileNode<D>& child : node.children) trees.push_back(&child);
  MergedBorder<D> merged = merge_resident(children, trees, *options.budget, counts, task);
  if (merged.border.open()) {
    return pass_up(std::move(merged.border), block, sequencer, counts);
  }
  const auto may_be_changed = [&](const ConflictRegion<D>& region) {
    return std::any_of(outside.begin(), outside.end(),
                       [&](const TileNode<D>* tile) { return region.may_meet_leaf(*tile); });
  };
  Settled<D> settled = settle_merged(merged, block, options.output, may_be_changed, counts.times);
  final_simplices += settled.final_simplices;
  return pass_on(std::move(settled), block, sequencer, counts);
}

template Border<2> triangulate_tile(TilePoints<2>, const Outside<2>&, const TileOptions&,
                                    Sequencer<2>&, StreamCounts&, std::uint32_t,
                                    const std::function<void()>&, Task&);
template Border<3> triangulate_tile(TilePoints<3>, const Outside<3>&, const TileOptions&,
                                    Sequencer<3>&, StreamCounts&, std::uint32_t,
                                    const std::function<void()>&, Task&);
template Border<2> merge_tiles(std::span<Border<2>>, const TileNode<2>&, const Outside<2>&,
                               const TileOptions&, Sequencer<2>&, StreamCounts&, std::uint32_t,
                               std::uint64_t&, Task&);
template Border<3> merge_tiles(std::span<Border<3>>, const TileNode<3>&, const Outside<3>&,
                               const TileOptions&, Sequencer<3>&, StreamCounts&, std::uint32_t,
                               std::uint64_t&, Task&);

}  // namespace spillway
