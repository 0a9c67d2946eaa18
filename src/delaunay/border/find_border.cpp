#include "src/delaunay/border/find_border.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <mutex>
#include <stdexcept>

#include "src/delaunay/border/region_batch.h"
#include "src/delaunay/common/hash.h"
#include "src/parallel/parallel.h"

namespace spillway::detail {
namespace {

/// Simplices that a task of the border search looks at before it shares its work.
constexpr std::size_t kBorderBatch = 512;
constexpr std::size_t kCandidateGrain = 4096;

/// Calls visit(id, region) for those of the simplices that a point of a sibling may change, in
/// their order.
template <int D, typename Visit>
void for_each_changeable(std::span<const SimplexId> simplices,
                         const Triangulation<D>& triangulation, const Siblings<D>& siblings,
                         const Visit& visit) {
  PointSearch<D> search(siblings);
  for_each_region<D>(
      simplices.size(), [&](std::size_t s) { return triangulation.simplex(simplices[s]).vertices; },
      triangulation.points,
      [&](std::size_t s, const ConflictRegion<D>& region) {
        if (search.may_hold_a_point(region)) visit(simplices[s], region);
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

/// The infinite simplices that have a corner on a side of `box` beyond which a sibling lies.
template <int D>
std::vector<SimplexId> beside_siblings(const Triangulation<D>& triangulation, const Box<D>& box,
                                       std::span<const SimplexId> hull,
                                       const Siblings<D>& siblings) {
  std::array<bool, D> below{};
  std::array<bool, D> above{};
  for (const Part<D>* part : siblings.parts) {
    int k = 0;
    while (k < D && part->box.lo[k] <= box.hi[k] && part->box.hi[k] >= box.lo[k]) ++k;
    if (k == D) throw std::logic_error("boxes of siblings that lie apart on no axis");
    (part->box.lo[k] > box.hi[k] ? above : below)[k] = true;
  }
  const auto on_such_a_side = [&](VertexId v) {
    if (v == kInfiniteVertex) return false;
    const Point<D>& p = triangulation.points[v];
    bool on = false;
    for (int k = 0; k < D; ++k) {
      on = on || (below[k] && p[k] == box.lo[k]) || (above[k] && p[k] == box.hi[k]);
    }
    return on;
  };
  std::vector<std::vector<SimplexId>> found(grain_count(hull.size(), kCandidateGrain));
  parallel_for(hull.size(), kCandidateGrain,
               [&](std::size_t g, std::size_t begin, std::size_t end) {
                 for (std::size_t h = begin; h < end; ++h) {
                   const auto& vertices = triangulation.simplex(hull[h]).vertices;
                   if (std::any_of(vertices.begin(), vertices.end(), on_such_a_side)) {
                     found[g].push_back(hull[h]);
                   }
                 }
               });
  std::vector<SimplexId> all;
  for (const auto& some : found) all.insert(all.end(), some.begin(), some.end());
  return all;
}

template <int D>
void add_leaves(const Part<D>& part, std::vector<std::uint32_t>& lists) {
  if (part.leaf()) lists.push_back(part.list);
  for (const Part<D>& child : part.children) add_leaves(child, lists);
}

}  // namespace

template <int D>
bool asking_for_points_pays(const Triangulation<D>& triangulation, const Part<D>& part,
                            const Siblings<D>& siblings) {
  constexpr std::size_t kSample = 256;
  constexpr std::size_t kMostBoxesOfOne = 256;  // on average; others take none
  std::vector<std::uint32_t> leaves;
  add_leaves(part, leaves);
  PointSearch<D> search(siblings);
  std::size_t held = 0;
  for (std::size_t s = 0; s < kSample; ++s) {
    const auto& simplices = triangulation.lists[leaves[s * leaves.size() / kSample]].simplices;
    if (simplices.empty()) continue;
    const Simplex<D>& simplex = simplices[mix64(s) % simplices.size()];
    if (simplex.removed()) continue;
    const ConflictRegion<D> region(simplex.vertices, triangulation.points.span());
    held += search.may_hold_a_point(region) ? 1 : 0;
    if (search.boxes_seen() > kSample * kMostBoxesOfOne) return false;
  }
  return held <= kSample / 2;
}

template <int D>
std::vector<SimplexId> find_border(const Triangulation<D>& triangulation, const Box<D>& box,
                                   std::span<const SimplexId> hull, const Siblings<D>& siblings,
                                   std::span<ListMarks> marks) {
  const auto mark = [&](SimplexId id) { return std::atomic_ref<Mark>(marks[id.list][id.index]); };
  std::mutex mutex;
  std::vector<SimplexId> border;  // guarded by `mutex`
  parallel_work_queue(
      beside_siblings<D>(triangulation, box, hull, siblings), kBorderBatch,
      [&](std::span<const SimplexId> candidates, std::vector<SimplexId>& found) {
        std::vector<SimplexId> fresh;
        std::copy_if(candidates.begin(), candidates.end(), std::back_inserter(fresh),
                     [&](SimplexId id) {
                       return mark(id).load(std::memory_order_relaxed) == Mark::kInterior;
                     });
        std::vector<SimplexId> mine;
        for_each_changeable<D>(
            fresh, triangulation, siblings, [&](SimplexId id, const auto& /*region*/) {
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
                                    const Siblings<D>& siblings, std::span<ListMarks> marks) {
  ListMarks& mark = marks[list];
  parallel_for(
      candidates.size(), kCandidateGrain, [&](std::size_t, std::size_t begin, std::size_t end) {
        std::vector<SimplexId> some;
        for (const std::uint32_t s : candidates.subspan(begin, end - begin)) {
          some.push_back({list, s});
        }
        for_each_changeable<D>(some, triangulation, siblings,
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

template bool asking_for_points_pays<2>(const Triangulation<2>&, const Part<2>&,
                                        const Siblings<2>&);
template bool asking_for_points_pays<3>(const Triangulation<3>&, const Part<3>&,
                                        const Siblings<3>&);
template std::vector<SimplexId> find_border<2>(const Triangulation<2>&, const Box<2>&,
                                               std::span<const SimplexId>, const Siblings<2>&,
                                               std::span<ListMarks>);
template std::vector<SimplexId> border_among<2>(const Triangulation<2>&, std::uint32_t,
                                                std::span<const std::uint32_t>, const Siblings<2>&,
                                                std::span<ListMarks>);
template std::vector<SimplexId> find_border<3>(const Triangulation<3>&, const Box<3>&,
                                               std::span<const SimplexId>, const Siblings<3>&,
                                               std::span<ListMarks>);
template std::vector<SimplexId> border_among<3>(const Triangulation<3>&, std::uint32_t,
                                                std::span<const std::uint32_t>, const Siblings<3>&,
                                                std::span<ListMarks>);

}  // namespace spillway::detail
