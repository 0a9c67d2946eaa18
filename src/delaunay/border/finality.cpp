#include "src/delaunay/border/finality.h"

#include <algorithm>
#include <atomic>
#include <mutex>

#include "src/geometry/constructions/circumsphere.h"
#include "src/parallel/parallel.h"

namespace spillway::detail {
namespace {

/// Simplices that a task of the border search looks at before it shares its work.
constexpr std::size_t kBorderBatch = 512;
constexpr std::size_t kCandidateGrain = 4096;

/// Calls visit(id, region) for those of the simplices that a point of `others` may change, in their
/// order.
template <int D, typename Visit>
void for_each_changeable(std::span<const SimplexId> simplices,
                         const Triangulation<D>& triangulation,
                         std::span<const Part<D>* const> others, const Visit& visit) {
  for_each_region<D>(
      simplices.size(), [&](std::size_t s) { return triangulation.simplex(simplices[s]).vertices; },
      triangulation.points,
      [&](std::size_t s, const ConflictRegion<D>& region) {
        if (std::any_of(others.begin(), others.end(),
                        [&](const Part<D>* other) { return region.may_meet_leaf(*other); })) {
          visit(simplices[s], region);
        }
      });
}

/// Marks those kVague ones of a leaf's `candidates` kBorder that have a neighbour there, and what
/// is connected to them by kVague ones. All neighbours are in the leaf's list.
template <int D>
void connect(std::span<const std::uint32_t> candidates, const SimplexList<D>& list,
             ListMarks& marks) {
  std::vector<std::uint32_t> reached;
  const auto reach = [&](std::uint32_t s) {
    if (marks[s] != Mark::kVague) return;
    marks[s] = Mark::kBorder;
    reached.push_back(s);
  };
  for (const std::uint32_t s : candidates) {
    if (marks[s] != Mark::kVague) continue;
    for (const std::uint32_t n : list.simplices[s].neighbours) {
      if (marks[n] == Mark::kBorder) reach(s);
    }
    while (!reached.empty()) {
      const std::uint32_t from = reached.back();
      reached.pop_back();
      for (const std::uint32_t n : list.simplices[from].neighbours) reach(n);
    }
  }
}

}  // namespace

template <int D>
ConflictRegion<D>::ConflictRegion(const std::array<VertexId, D + 1>& vertices,
                                  std::span<const Point<D>> points) {
  const auto infinite = std::find(vertices.begin(), vertices.end(), kInfiniteVertex);
  if (infinite == vertices.end()) {
    std::array<Point<D>, D + 1> corners;
    for (int i = 0; i <= D; ++i) corners[i] = points[vertices[i]];
    ball_ = certified_ball<D>(corners);
    return;
  }
  infinite_ = true;
  // Bring the infinite vertex to the end by an even permutation: the rest is the facet as
  // half_space_meets wants it.
  std::array<VertexId, D + 1> even = vertices;
  if (infinite != vertices.end() - 1) {
    std::swap(even[infinite - vertices.begin()], even[D]);
    std::swap(even[0], even[1]);
  }
  for (int i = 0; i < D; ++i) facet_[i] = points[even[i]];
}

template <int D>
bool ConflictRegion<D>::may_meet(const Box<D>& box) const {
  return infinite_ ? half_space_meets<D>(facet_, box) : spillway::detail::may_meet<D>(ball_, box);
}

template <int D>
std::vector<SimplexId> find_border(const Triangulation<D>& triangulation,
                                   std::span<const SimplexId> hull,
                                   std::span<const Part<D>* const> others,
                                   std::span<ListMarks> marks) {
  const auto mark = [&](SimplexId id) { return std::atomic_ref<Mark>(marks[id.list][id.index]); };
  std::mutex mutex;
  std::vector<SimplexId> border;  // guarded by `mutex`
  parallel_work_queue(
      std::vector<SimplexId>(hull.begin(), hull.end()), kBorderBatch,
      [&](std::span<const SimplexId> candidates, std::vector<SimplexId>& found) {
        std::vector<SimplexId> fresh;
        std::copy_if(candidates.begin(), candidates.end(), std::back_inserter(fresh),
                     [&](SimplexId id) {
                       return mark(id).load(std::memory_order_relaxed) == Mark::kInterior;
                     });
        std::vector<SimplexId> mine;
        for_each_changeable<D>(
            fresh, triangulation, others, [&](SimplexId id, const auto& /*region*/) {
              if (mark(id).exchange(Mark::kBorder, std::memory_order_relaxed) != Mark::kInterior) {
                return;
              }
              mine.push_back(id);
              for (int i = 0; i <= D; ++i) found.push_back(triangulation.neighbour(id, i));
            });
        const std::lock_guard lock(mutex);
        border.insert(border.end(), mine.begin(), mine.end());
      });
  return border;
}

template <int D>
std::vector<SimplexId> border_among(const Triangulation<D>& triangulation, std::uint32_t list,
                                    std::span<const std::uint32_t> candidates,
                                    std::span<const Part<D>* const> others,
                                    std::span<ListMarks> marks) {
  ListMarks& mark = marks[list];
  parallel_for(
      candidates.size(), kCandidateGrain, [&](std::size_t, std::size_t begin, std::size_t end) {
        std::vector<SimplexId> some;
        for (const std::uint32_t s : candidates.subspan(begin, end - begin)) {
          some.push_back({list, s});
        }
        for_each_changeable<D>(some, triangulation, others,
                               [&](SimplexId id, const ConflictRegion<D>& region) {
                                 mark[id.index] = region.tight() ? Mark::kBorder : Mark::kVague;
                               });
      });
  connect<D>(candidates, triangulation.lists[list], mark);
  std::vector<SimplexId> border;
  for (const std::uint32_t s : candidates) {
    if (mark[s] == Mark::kBorder) border.push_back({list, s});
    if (mark[s] == Mark::kVague) mark[s] = Mark::kInterior;
  }
  return border;
}

template class ConflictRegion<2>;
template class ConflictRegion<3>;
template std::vector<SimplexId> find_border<2>(const Triangulation<2>&, std::span<const SimplexId>,
                                               std::span<const Part<2>* const>,
                                               std::span<ListMarks>);
template std::vector<SimplexId> find_border<3>(const Triangulation<3>&, std::span<const SimplexId>,
                                               std::span<const Part<3>* const>,
                                               std::span<ListMarks>);
template std::vector<SimplexId> border_among<2>(const Triangulation<2>&, std::uint32_t,
                                                std::span<const std::uint32_t>,
                                                std::span<const Part<2>* const>,
                                                std::span<ListMarks>);
template std::vector<SimplexId> border_among<3>(const Triangulation<3>&, std::uint32_t,
                                                std::span<const std::uint32_t>,
                                                std::span<const Part<3>* const>,
                                                std::span<ListMarks>);

}  // namespace spillway::detail
