#include "src/delaunay/delaunay.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <numeric>

#include "src/delaunay/base_case/base_case.h"
#include "src/delaunay/border/find_border.h"
#include "src/delaunay/border/merge.h"
#include "src/delaunay/common/schedule.h"
#include "src/delaunay/common/tuning.h"
#include "src/delaunay/common/working_memory.h"
#include "src/error.h"
#include "src/geometry/dimensions.h"
#include "src/parallel/parallel.h"

namespace spillway::delaunay {
namespace {

/// Base cases of this size divide `points` points into `parts` parts, a power of two, with room for
/// cuts that miss the middle.
std::size_t leaf_points_for(std::size_t points, std::size_t parts) {
  constexpr double kSlack = 1.1;
  return static_cast<std::size_t>(
      std::ceil(static_cast<double>(points) / static_cast<double>(parts) * kSlack));
}

/// The default: of the good size, or two, so that a second thread has something to do.
template <int D>
std::size_t default_leaf_points(std::size_t points) {
  const std::size_t fewest = points >= 2 * Tuning<D>::kSmallestBaseCase ? 2 : 1;
  return leaf_points_for(
      points, std::bit_floor(std::max(
                  fewest, (points + Tuning<D>::kGoodBaseCase / 2) / Tuning<D>::kGoodBaseCase)));
}

/// Base cases that a border is divided into, to have something to do for every thread.
constexpr std::size_t kBorderBaseCases = 2;
constexpr std::size_t kSmallestBorderBaseCase = 4'096;

std::size_t border_leaf_points(std::size_t points, std::size_t largest) {
  return std::clamp(leaf_points_for(points, kBorderBaseCases),
                    std::min(kSmallestBorderBaseCase, largest), largest);
}

/// A set of at most so many points stays one base case if no cut of it pays.
constexpr std::size_t kLargestUndivided = std::size_t{1} << 24;

/// Of smaller sets that are divided, the longest axis is cut unseen: what a sample tells would cost
/// more than it saves. Borders are hollow more often than other sets: Tuning.
constexpr std::size_t kSmallestJudged = 32'768;

constexpr std::size_t kCopyGrain = std::size_t{1} << 16;

/// Made by all threads.
template <typename T>
SlabArray<T> copy_of(std::span<const T> items) {
  SlabArray<T> copy(items.size());
  parallel_for(items.size(), kCopyGrain, [&](std::size_t, std::size_t begin, std::size_t end) {
    std::copy(items.begin() + begin, items.begin() + end, copy.begin() + begin);
  });
  return copy;
}

/// Algorithm 1 on one array of points.
template <int D>
class Run {
 public:
  /// `in_place` says where base cases leave their simplices: see BaseCaseInput.
  Run(SlabArray<Point<D>> points, const DivideAndConquerOptions& options, bool in_place)
      : options_(options), in_place_(in_place) {
    result_.points = std::move(points);
    result_.input_index = SlabArray<VertexId>(result_.points.size());
    VertexId* const index = result_.input_index.begin();
    parallel_for(result_.points.size(), kCopyGrain,
                 [&](std::size_t, std::size_t begin, std::size_t end) {
                   std::iota(index + begin, index + end, static_cast<VertexId>(begin));
                 });
  }

  Triangulation<D> triangulate(std::size_t leaf_points, std::size_t smallest_judged,
                               Task& task) && {
    task.before.resize(1);
    const DivideOptions division{
        .leaf_points = leaf_points,
        .scheme = options_.division,
        .children = options_.children,
        .stop = options_.stop,
        .smallest_judged = smallest_judged,
        .largest_undivided = options_.leaf_points == 0 ? kLargestUndivided : 0};
    const Part<D> root =
        divide<D>(result_.points, result_.input_index, division, task.before.data());
    result_.lists.resize(root.list + 1);
    marks_.resize(root.list + 1);
    boxes_.resize(root.list + 1);
    duplicates_.resize(root.list + 1);
    leaf_points_ = leaf_points;
    root_list_ = root.list;
    PartSurface surface = triangulate_part(root, whole_space<D>(), task);
    result_.dimension = surface.dimension;
    result_.hull = std::move(surface.hull);
    for (const auto& some : duplicates_) {
      result_.duplicates.insert(result_.duplicates.end(), some.begin(), some.end());
    }
    return std::move(result_);
  }

 private:
  /// `safe_box` is a box around the part that has nothing in common with the boxes of others
  /// beside it.
  PartSurface triangulate_part(const Part<D>& part, const Box<D>& safe_box, Task& task) {
    if (options_.stop.stop_requested()) throw Interrupted();
    task.points = part.size();
    return part.leaf() ? triangulate_leaf(part, safe_box, task)
                       : triangulate_node(part, safe_box, task);
  }

  PartSurface triangulate_leaf(const Part<D>& part, const Box<D>& safe_box, Task& task) {
    task.kind = TaskKind::kBaseCase;
    const Stopwatch watch(task.seconds);
    BaseCase<D> leaf = triangulate_base_case<D>(
        {.points = std::span(result_.points).subspan(part.begin, part.size()),
         .input_index = std::span(result_.input_index).subspan(part.begin, part.size()),
         .first_vertex = part.begin,
         .safe_box = safe_box,
         .in_place = in_place_,
         .kernel = options_.kernel,
         .memory = options_.memory});
    if (part.list != root_list_) {
      boxes_[part.list] = RunBoxes<D>(result_.points.span().subspan(part.begin, part.size()));
    }
    PartSurface surface;
    surface.dimension = leaf.dimension;
    surface.open = leaf.dimension < D;
    for (const std::uint32_t i : leaf.hull) surface.hull.push_back({part.list, i});
    marks_[part.list] = ListMarks(leaf.simplices.size(), Mark::kFinal);
    if (leaf.not_inside) {
      for (const std::uint32_t i : *leaf.not_inside) marks_[part.list][i] = Mark::kInterior;
      surface.changeable = std::move(leaf.not_inside);
    }
    if (in_place_) leaf.simplices.shrink();
    result_.lists[part.list].simplices = std::move(leaf.simplices);
    duplicates_[part.list] = std::move(leaf.duplicates);
    if (surface.open) surface.vertices = distinct_vertices(part);
    if (options_.progress) options_.progress(points_done_ += part.size());
    return surface;
  }

  PartSurface triangulate_node(const Part<D>& part, const Box<D>& safe_box, Task& task) {
    task.kind = TaskKind::kNode;
    task.children.resize(part.children.size());
    std::vector<PartSurface> surfaces(part.children.size());
    TaskGroup group;
    for (std::size_t c = 0; c < part.children.size(); ++c) {
      Box<D> child_safe_box = safe_box;
      for (const Part<D>& other : part.children) {
        if (&other != &part.children[c]) cut_back(child_safe_box, part.children[c].box, other.box);
      }
      group.run([&, c, child_safe_box] {
        surfaces[c] = triangulate_part(part.children[c], child_safe_box, task.children[c]);
      });
    }
    group.wait();
    if (options_.stop.stop_requested()) throw Interrupted();
    PartSurface surface = merge<D>(
        result_, marks_, boxes_, part, surfaces, part.list != root_list_,
        [this](SlabArray<Point<D>> points, std::size_t part_size, Task& border_task) {
          return triangulate_border(std::move(points), part_size, border_task);
        },
        task);
    if (surface.open) {
      drop_simplices(part);
      surface.vertices = distinct_vertices(part);
    }
    return surface;
  }

  /// A part's vertices without those that equal another one.
  [[nodiscard]] std::vector<VertexId> distinct_vertices(const Part<D>& part) const {
    if (!part.leaf()) {
      std::vector<VertexId> vertices;
      for (const Part<D>& child : part.children) {
        const std::vector<VertexId> some = distinct_vertices(child);
        vertices.insert(vertices.end(), some.begin(), some.end());
      }
      return vertices;
    }
    std::vector<VertexId> dropped;
    for (const DroppedDuplicate& duplicate : duplicates_[part.list])
      dropped.push_back(duplicate.dropped);
    std::vector<VertexId> all(part.size());
    std::iota(all.begin(), all.end(), part.begin);
    std::vector<VertexId> vertices;
    std::set_difference(all.begin(), all.end(), dropped.begin(), dropped.end(),
                        std::back_inserter(vertices));
    return vertices;
  }

  /// Gives up the simplices of a part that stays open.
  void drop_simplices(const Part<D>& part) {
    for (const Part<D>& child : part.children) drop_simplices(child);
    result_.lists[part.list] = {};
    marks_[part.list] = {};
  }

  Triangulation<D> triangulate_border(SlabArray<Point<D>> points, std::size_t part_size,
                                      Task& task) const {
    const auto count = static_cast<double>(points.size());
    std::size_t leaf_points = points.size();
    if (count <= kLargestBorder * static_cast<double>(part_size)) {
      leaf_points = border_leaf_points(points.size(), leaf_points_);
    }
    DivideAndConquerOptions options = options_;
    options.progress = nullptr;
    return Run(std::move(points), options, false)
        .triangulate(leaf_points, Tuning<D>::kSmallestJudgedBorder, task);
  }

  const DivideAndConquerOptions& options_;
  const bool in_place_;
  std::size_t leaf_points_ = 0;
  std::uint32_t root_list_ = 0;
  std::atomic<std::size_t> points_done_ = 0;
  Triangulation<D> result_;
  std::vector<ListMarks> marks_;                           ///< by list
  std::vector<RunBoxes<D>> boxes_;                         ///< of leaves, by list
  std::vector<std::vector<DroppedDuplicate>> duplicates_;  ///< by list
};

}  // namespace

template <int D>
Triangulation<D> delaunay_triangulation(std::span<const Point<D>> points,
                                        const DivideAndConquerOptions& options) {
  struct Release {
    ~Release() { release_base_case_memory(); }
  } const release_at_the_end;
  if (points.size() > kMaxVertices) {
    throw Failure("more than " + std::to_string(kMaxVertices) +
                      " points: too many for one triangulation in memory",
                  ErrorCode::kTooLarge);
  }
  const std::size_t leaf_points =
      options.leaf_points == 0 ? default_leaf_points<D>(points.size()) : options.leaf_points;
  const unsigned threads = options.threads == 0 ? available_threads() : options.threads;
  // With more base cases the memory of the first is worth more for those that follow.
  const bool in_place = points.size() <= 2 * threads * leaf_points;
  Triangulation<D> result;
  Task unused;
  with_threads(threads, [&] {
    result = Run<D>(copy_of(points), options, in_place)
                 .triangulate(leaf_points, kSmallestJudged,
                              options.tasks == nullptr ? unused : *options.tasks);
  });
  return result;
}

template <int D>
Triangulation<D> border_delaunay(SlabArray<Point<D>> points, Kernel kernel, WorkLease* memory,
                                 Task& task) {
  const std::size_t leaf_points =
      std::max<std::size_t>(points.size() / 4, Tuning<D>::kGoodBorderBaseCase);
  const DivideAndConquerOptions options{.kernel = kernel, .memory = memory};
  return Run<D>(std::move(points), options, false)
      .triangulate(leaf_points, Tuning<D>::kSmallestJudgedBorder, task);
}

template <int D>
void recycle(Triangulation<D> used) {
  for (SimplexList<D>& list : used.lists) recycle<D>(std::move(list.simplices));
}

#define SPILLWAY_INSTANTIATE(D)                                                                 \
  template Triangulation<D> border_delaunay<D>(SlabArray<Point<D>>, Kernel, WorkLease*, Task&); \
  template Triangulation<D> delaunay_triangulation<D>(std::span<const Point<D>>,                \
                                                      const DivideAndConquerOptions&);          \
  template void recycle<D>(Triangulation<D>);
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::delaunay
