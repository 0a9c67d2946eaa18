#include "stream/triangulate/border.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "src/delaunay/acceptance.h"
#include "src/delaunay/delaunay.h"
#include "src/delaunay/divide.h"
#include "src/delaunay/schedule.h"
#include "src/parallel/parallel.h"
#include "src/runtime/memory_budget.h"
#include "stream/tiles/tile_tree.h"

namespace spillway::detail {
namespace {

constexpr std::size_t kGrain = 4096;

/// Memory for each point of a border while it is triangulated, measured; and where the border is
/// all there is, as for points of a sphere: then the parts of that triangulation have borders as
/// large.
template <int D>
constexpr std::uint64_t kMergeBytes = D == 2 ? 320 : 900;
template <int D>
constexpr std::uint64_t kAllBorderMergeBytes = D == 2 ? 320 : 1400;

/// Memory for each point of a border, where there are this many simplices for each of them: all
/// there can be in the plane, and more than there usually are in space.
template <int D>
constexpr std::uint64_t kBorderBytes = sizeof(BorderVertex<D>) +
                                       (D == 2 ? 2 : 8) * sizeof(std::array<VertexId, D + 1>);

template <int D, PointTree Tree>
class Merge {
  using Corners = std::array<VertexId, D + 1>;
  using Questions = typename Acceptance<D>::template Questions<>;

 public:
  Merge(std::span<Border<D>> children, std::span<const Tree* const> trees, MemoryBudget& budget,
        Kernel kernel)
      : children_(children), trees_(trees), budget_(budget), kernel_(kernel) {}

  MergedBorder<D> run(Task& task) {
    task.after.resize(3);
    std::uint64_t bytes = 0;
    for (const Border<D>& child : children_) bytes += child.bytes();
    const MemoryLease copy(budget_, bytes, "the merge of borders");
    find_exposed(task.after[0]);
    if (border_vertices_.empty()) return std::move(result_);  // one child, with nothing beside it
    const MemoryLease lease(budget_, merge_bytes<D>(border_vertices_.size(), points_below()),
                            "the triangulation of a border");
    triangulate(task.after[1]);
    accept(task.after[2]);
    return std::move(result_);
  }

 private:
  [[nodiscard]] std::uint64_t points_below() const {
    std::uint64_t points = 0;
    for (const Tree* tree : trees_) points += tree->size();
    return points;
  }

  /// Numbers all vertices, sorts the children's simplices into those that a sibling may change and
  /// those that stay, and collects the vertices to be triangulated.
  void find_exposed(Task& task) {
    task.kind = TaskKind::kBorder;
    const Stopwatch watch(task.seconds);
    auto& vertices = result_.border.vertices;
    first_vertex_.assign(1, 0);
    for (const Border<D>& child : children_) {
      first_vertex_.push_back(first_vertex_.back() + static_cast<VertexId>(child.vertices.size()));
      result_.border.dimension = std::max(result_.border.dimension, child.dimension);
    }
    vertices.reserve(first_vertex_.back());
    std::vector<bool> wanted(first_vertex_.back());
    for (std::size_t c = 0; c < children_.size(); ++c) {
      Border<D> child = std::exchange(children_[c], {});
      open_.push_back(child.open());
      const std::vector<std::uint8_t> exposed = exposed_simplices(child, c);
      for (std::size_t s = 0; s < child.simplices.size(); ++s) {
        Corners corners = child.simplices[s];
        for (VertexId& v : corners) {
          if (v == kInfiniteVertex) continue;
          v += first_vertex_[c];
          if (exposed[s] != 0) wanted[v] = true;
        }
        (exposed[s] != 0 ? exposed_ : result_.border.simplices).push_back(corners);
      }
      if (child.open()) {
        std::fill(wanted.begin() + first_vertex_[c], wanted.begin() + first_vertex_[c + 1], true);
      }
      vertices.insert(vertices.end(), child.vertices.begin(), child.vertices.end());
    }
    for (VertexId v = 0; v < wanted.size(); ++v) {
      if (wanted[v]) border_vertices_.push_back(v);
    }
    result_.tested = result_.border.simplices.size();
    result_.retriangulated = border_vertices_.size();
    task.points = border_vertices_.size();
    task.grains = std::max<std::size_t>(1, grain_count(exposed_.size(), kGrain));
  }

  [[nodiscard]] std::vector<std::uint8_t> exposed_simplices(const Border<D>& child,
                                                            std::size_t c) const {
    const std::vector<Point<D>> points = child.positions();
    std::vector<std::uint8_t> exposed(child.simplices.size());
    parallel_for(exposed.size(), kGrain, [&](std::size_t, std::size_t begin, std::size_t end) {
      for_each_region<D>(
          end - begin, [&](std::size_t s) { return child.simplices[begin + s]; }, points,
          [&](std::size_t s, const ConflictRegion<D>& region) {
            for (std::size_t other = 0; other < trees_.size() && exposed[begin + s] == 0; ++other) {
              if (other != c && region.may_meet_leaf(*trees_[other])) exposed[begin + s] = 1;
            }
          });
    });
    return exposed;
  }

  void triangulate(Task& task) {
    SlabArray<Point<D>> points(border_vertices_.size());
    std::transform(border_vertices_.begin(), border_vertices_.end(), points.begin(),
                   [&](VertexId v) { return result_.border.vertices[v].position; });
    mesh_ = border_delaunay<D>(std::move(points), kernel_, task);
    result_.border.dimension = std::max(result_.border.dimension, mesh_.dimension);
  }

  void accept(Task& task) {
    task.kind = TaskKind::kAccept;
    task.points = border_vertices_.size();
    const Stopwatch watch(task.seconds);
    const Acceptance<D> acceptance(std::span<const VertexId>(first_vertex_).subspan(1), open_,
                                   exposed_);
    std::vector<VertexId> number(mesh_.input_index.size());
    for (std::size_t v = 0; v < number.size(); ++v) {
      number[v] = border_vertices_[mesh_.input_index[v]];
    }
    for (const SimplexList<D>& list : mesh_.lists) {
      const std::span simplices(list.simplices.data(), list.simplices.size());
      std::vector<std::vector<Corners>> accepted(grain_count(simplices.size(), kGrain));
      parallel_for(
          simplices.size(), kGrain, [&](std::size_t g, std::size_t begin, std::size_t end) {
            Questions questions(acceptance);
            for (std::size_t first = begin; first < end; first += Questions::kBatch) {
              const std::size_t count = std::min(Questions::kBatch, end - first);
              append_accepted(simplices.subspan(first, count), number, questions, accepted[g]);
            }
          });
      auto& result = result_.border.simplices;
      for (const auto& some : accepted) result.insert(result.end(), some.begin(), some.end());
    }
    task.grains = std::max<std::size_t>(1, grain_count(exposed_.size(), kGrain));
  }

  /// Of a batch of the mesh's simplices, appends those to be accepted: first the new ones. `number`
  /// has the mesh's vertices in the numbering of the merge.
  void append_accepted(std::span<const Simplex<D>> batch, const std::vector<VertexId>& number,
                       Questions& questions, std::vector<Corners>& accepted) const {
    const auto found = [&accepted](const Corners& corners, std::monostate, std::uint32_t) {
      accepted.push_back(corners);
    };
    for (const Simplex<D>& simplex : batch) {
      if (simplex.removed()) continue;
      Corners corners = simplex.vertices;
      for (VertexId& v : corners) v = v == kInfiniteVertex ? v : number[v];
      if (questions.is_new(corners, {}, found)) accepted.push_back(corners);
    }
    questions.answer(found);
  }

  std::span<Border<D>> children_;
  std::span<const Tree* const> trees_;
  MemoryBudget& budget_;
  Kernel kernel_;
  std::vector<VertexId> first_vertex_;  ///< by child, and one more
  std::vector<bool> open_;              ///< by child
  std::vector<Corners> exposed_;
  std::vector<VertexId> border_vertices_;
  Triangulation<D> mesh_;
  MergedBorder<D> result_;
};

}  // namespace

template <int D>
std::uint64_t enough_memory(std::uint64_t points) {
  return points * (kLoadedPointBytes + 2 * kBorderBytes<D> + kAllBorderMergeBytes<D>);
}

template <int D>
std::uint64_t merge_bytes(std::uint64_t border_points, std::uint64_t below) {
  return border_points * (2 * border_points > below ? kAllBorderMergeBytes<D> : kMergeBytes<D>);
}

template <int D, PointTree Tree>
MergedBorder<D> merge_borders(std::span<Border<D>> children, std::span<const Tree* const> trees,
                              MemoryBudget& budget, Task& task, Kernel kernel) {
  return Merge<D, Tree>(children, trees, budget, kernel).run(task);
}

template std::uint64_t enough_memory<2>(std::uint64_t);
template std::uint64_t enough_memory<3>(std::uint64_t);
template std::uint64_t merge_bytes<2>(std::uint64_t, std::uint64_t);
template std::uint64_t merge_bytes<3>(std::uint64_t, std::uint64_t);
template MergedBorder<2> merge_borders(std::span<Border<2>>, std::span<const Part<2>* const>,
                                       MemoryBudget&, Task&, Kernel);
template MergedBorder<3> merge_borders(std::span<Border<3>>, std::span<const Part<3>* const>,
                                       MemoryBudget&, Task&, Kernel);
template MergedBorder<2> merge_borders(std::span<Border<2>>, std::span<const TileNode<2>* const>,
                                       MemoryBudget&, Task&, Kernel);
template MergedBorder<3> merge_borders(std::span<Border<3>>, std::span<const TileNode<3>* const>,
                                       MemoryBudget&, Task&, Kernel);

}  // namespace spillway::detail
