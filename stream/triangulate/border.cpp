#include "stream/triangulate/border.h"

#include <algorithm>
#include <atomic>
#include <numeric>
#include <utility>

#include "src/delaunay/border/acceptance.h"
#include "src/delaunay/border/exposure.h"
#include "src/delaunay/common/schedule.h"
#include "src/delaunay/delaunay.h"
#include "src/delaunay/division/divide.h"
#include "src/geometry/dimensions.h"
#include "src/parallel/parallel.h"
#include "stream/tiles/storage/tile_points.h"
#include "stream/tiles/tile_node.h"
#include "stream/triangulate/tuning.h"

namespace spillway::stream {
namespace {

constexpr std::size_t kGrain = 4096;

/// The same for each simplex, where there are very many for a point.
constexpr std::uint64_t kMergedSimplexBytes = 180;

/// A merge that takes more than this share of the limit has no use for what leaves have kept.
constexpr std::uint64_t kLargeMergeShare = 4;

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
    result_.memory = WorkLease(budget_, bytes, "the merge of borders");
    find_exposed(task.after[0]);
    if (border_vertices_.empty()) return std::move(result_);  // one child, with nothing beside it
    const std::uint64_t wanted = merge_bytes<D>(border_vertices_.size(), points_below());
    result_.memory.extend(wanted, "the triangulation of a border");
    if (wanted > budget_.limit() / kLargeMergeShare) release_base_case_memory();
    budget_.give_back_freed(wanted);
    isolated([&] { triangulate(task.after[1]); });
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
    first_vertex_.assign(1, 0);
    for (const Border<D>& child : children_) {
      first_vertex_.push_back(first_vertex_.back() + static_cast<VertexId>(child.vertices.size()));
      result_.border.dimension = std::max(result_.border.dimension, child.dimension);
    }
    const VertexId count = first_vertex_.back();
    result_.border.vertices.resize(count);
    wanted_.assign(count, 0);
    result_.exposure_is_known = std::all_of(children_.begin(), children_.end(), knows_exposure);
    for (std::size_t c = 0; c < children_.size(); ++c) {
      Border<D> child = std::exchange(children_[c], {});
      open_.push_back(child.open());
      sort_out(child, c);
      take_vertices(child, c);
    }
    border_vertices_ = numbers_of_wanted();
    wanted_ = {};
    result_.tested = result_.border.simplices.size();
    result_.retriangulated = border_vertices_.size();
    task.points = border_vertices_.size();
    task.grains = std::max<std::size_t>(1, grain_count(exposed_.size(), kGrain));
  }

  /// Of an open child all vertices are wanted.
  void take_vertices(const Border<D>& child, std::size_t c) {
    const VertexId first = first_vertex_[c];
    const std::size_t record =
        child.vertices.empty() ? 0 : child.attributes.size() / child.vertices.size();
    std::vector<std::byte>& attributes = result_.border.attributes;
    if (record > 0) attributes.resize(first_vertex_.back() * record);
    parallel_for(child.vertices.size(), kGrain,
                 [&](std::size_t, std::size_t begin, std::size_t end) {
                   std::copy(child.vertices.begin() + begin, child.vertices.begin() + end,
                             result_.border.vertices.begin() + first + begin);
                   std::copy(child.attributes.begin() + begin * record,
                             child.attributes.begin() + end * record,
                             attributes.begin() + (first + begin) * record);
                   if (!child.open()) return;
                   std::fill(wanted_.begin() + first + begin, wanted_.begin() + first + end, 1);
                 });
  }

  [[nodiscard]] std::vector<VertexId> numbers_of_wanted() const {
    std::vector<std::vector<VertexId>> found(grain_count(wanted_.size(), kGrain));
    parallel_for(wanted_.size(), kGrain, [&](std::size_t g, std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        if (wanted_[v] != 0) found[g].push_back(static_cast<VertexId>(v));
      }
    });
    std::vector<VertexId> all;
    append_all(found, all);
    return all;
  }

  /// Appends the items of many vectors in their order, by all threads.
  template <typename T>
  static void append_all(const std::vector<std::vector<T>>& some, std::vector<T>& all) {
    std::vector<std::size_t> first(some.size() + 1, all.size());
    for (std::size_t g = 0; g < some.size(); ++g) first[g + 1] = first[g] + some[g].size();
    all.resize(first.back());
    parallel_for(some.size(), 1, [&](std::size_t g, std::size_t, std::size_t) {
      std::copy(some[g].begin(), some[g].end(), all.begin() + first[g]);
    });
  }

  /// Sorts a child's simplices, in numbers of the merge, into those that are exposed, whose
  /// vertices are marked, and the others.
  void sort_out(Border<D>& child, std::size_t c) {
    std::vector<Exposure>& exposure = child.exposure;
    if (!knows_exposure(child)) exposure = exposure_to_siblings(child, c);
    const std::size_t count = child.simplices.size();
    std::vector<std::size_t> exposed_before(grain_count(count, kGrain) + 1);
    parallel_for(count, kGrain, [&](std::size_t g, std::size_t begin, std::size_t end) {
      exposed_before[g + 1] = static_cast<std::size_t>(
          std::count_if(exposure.begin() + begin, exposure.begin() + end,
                        [](Exposure levels) { return (levels & 1) != 0; }));
    });
    std::partial_sum(exposed_before.begin(), exposed_before.end(), exposed_before.begin());
    auto& kept = result_.border.simplices;
    const std::size_t first_exposed = exposed_.size();
    const std::size_t first_kept = kept.size();
    exposed_.resize(first_exposed + exposed_before.back());
    kept.resize(first_kept + count - exposed_before.back());
    if (result_.exposure_is_known) result_.border.exposure.resize(kept.size());
    parallel_for(count, kGrain, [&](std::size_t g, std::size_t begin, std::size_t end) {
      SortedOut some(end - begin);
      sort_out_grain(child, c, begin, end, some);
      std::copy_n(some.exposed.begin(), some.exposed_count,
                  exposed_.begin() + first_exposed + exposed_before[g]);
      const std::size_t to = first_kept + begin - exposed_before[g];
      std::copy_n(some.kept.begin(), some.kept_count, kept.begin() + to);
      if (!result_.exposure_is_known) return;
      std::copy_n(some.kept_exposure.begin(), some.kept_count,
                  result_.border.exposure.begin() + to);
    });
  }

  /// The simplices of a grain; each list has room for one more, that is written and not kept.
  struct SortedOut {
    explicit SortedOut(std::size_t count)
        : exposed(count + 1), kept(count + 1), kept_exposure(count + 1) {}

    std::vector<Corners> exposed;
    std::vector<Corners> kept;
    std::vector<Exposure> kept_exposure;
    std::size_t exposed_count = 0;
    std::size_t kept_count = 0;
  };

  /// Nobody can tell which comes next: without branches.
  void sort_out_grain(const Border<D>& child, std::size_t c, std::size_t begin, std::size_t end,
                      SortedOut& some) {
    for (std::size_t s = begin; s < end; ++s) {
      const Exposure levels = child.exposure[s];
      const std::size_t is_exposed = levels & 1;
      Corners corners = child.simplices[s];
      for (VertexId& v : corners) v = v != kInfiniteVertex ? v + first_vertex_[c] : v;
      some.exposed[some.exposed_count] = corners;
      some.kept[some.kept_count] = corners;
      some.kept_exposure[some.kept_count] = levels >> 1;
      some.exposed_count += is_exposed;
      some.kept_count += 1 - is_exposed;
    }
    for (std::size_t s = 0; s < some.exposed_count; ++s) {
      for (const VertexId v : some.exposed[s]) {
        // Other threads may set it, too.
        if (v != kInfiniteVertex) {
          std::atomic_ref(wanted_[v]).store(1, std::memory_order_relaxed);
        }
      }
    }
  }

  [[nodiscard]] static bool knows_exposure(const Border<D>& child) {
    return child.exposure.size() == child.simplices.size();
  }

  /// Bit 0 of the exposure of a child's simplices, where it is not known.
  [[nodiscard]] std::vector<Exposure> exposure_to_siblings(const Border<D>& child,
                                                           std::size_t c) const {
    const std::vector<Point<D>> points = child.positions();
    std::vector<const Tree*> siblings;
    for (std::size_t other = 0; other < trees_.size(); ++other) {
      if (other != c) siblings.push_back(trees_[other]);
    }
    std::vector<Exposure> exposure(child.simplices.size());
    delaunay::find_exposed<D, Tree>(child.simplices, points, siblings,
                                    [&exposure](std::size_t s) { exposure[s] = 1; });
    return exposure;
  }

  void triangulate(Task& task) {
    SlabArray<Point<D>> points(border_vertices_.size());
    parallel_for(points.size(), kGrain, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        points[i] = result_.border.vertices[border_vertices_[i]].position;
      }
    });
    mesh_ = border_delaunay<D>(std::move(points), kernel_, &result_.memory, task);
    result_.border.dimension = std::max(result_.border.dimension, mesh_.dimension);
  }

  void accept(Task& task) {
    task.kind = TaskKind::kAccept;
    task.points = border_vertices_.size();
    const Stopwatch watch(task.seconds);
    const Acceptance<D> acceptance(std::span<const VertexId>(first_vertex_).subspan(1), open_,
                                   exposed_);
    std::vector<VertexId> number(mesh_.input_index.size());
    parallel_for(number.size(), kGrain, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) number[v] = border_vertices_[mesh_.input_index[v]];
    });
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
      append_all(accepted, result_.border.simplices);
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
  std::vector<std::uint8_t> wanted_;    ///< by vertex, whether it is to be triangulated
  std::vector<Corners> exposed_;
  std::vector<VertexId> border_vertices_;
  Triangulation<D> mesh_;
  MergedBorder<D> result_;
};

}  // namespace

template <int D>
std::uint64_t enough_memory(std::uint64_t points, std::size_t record_size,
                            std::uint64_t simplices_a_point) {
  const std::uint64_t border = sizeof(BorderVertex<D>) + record_size +
                               simplices_a_point * sizeof(std::array<VertexId, D + 1>);
  const std::uint64_t merge =
      std::max(TileTuning<D>::kAllBorderMergeBytes, simplices_a_point * kMergedSimplexBytes);
  return points * (kLoadedPointBytes + record_size + 2 * border + merge);
}

template <int D>
std::uint64_t enough_for(const WorkForecast& forecast, std::uint64_t points) {
  constexpr double kMargin = 1.25;
  const auto count = static_cast<double>(points);
  return static_cast<std::uint64_t>(
      std::min(0x1p62, kMargin * (count * kLoadedPointBytes + forecast.bytes_for(count))));
}

template <int D>
std::uint64_t merge_bytes(std::uint64_t border_points, std::uint64_t below) {
  return border_points * (2 * border_points > below ? TileTuning<D>::kAllBorderMergeBytes
                                                    : TileTuning<D>::kMergeBytes);
}

template <int D, PointTree Tree>
MergedBorder<D> merge_borders(std::span<Border<D>> children, std::span<const Tree* const> trees,
                              MemoryBudget& budget, Task& task, Kernel kernel) {
  return Merge<D, Tree>(children, trees, budget, kernel).run(task);
}

#define SPILLWAY_INSTANTIATE(D)                                                                 \
  template std::uint64_t enough_memory<D>(std::uint64_t, std::size_t, std::uint64_t);           \
  template std::uint64_t enough_for<D>(const WorkForecast&, std::uint64_t);                     \
  template std::uint64_t merge_bytes<D>(std::uint64_t, std::uint64_t);                          \
  template MergedBorder<D> merge_borders(std::span<Border<D>>, std::span<const Part<D>* const>, \
                                         MemoryBudget&, Task&, Kernel);                         \
  template MergedBorder<D> merge_borders(                                                       \
      std::span<Border<D>>, std::span<const TileNode<D>* const>, MemoryBudget&, Task&, Kernel);
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::stream
