#include "src/delaunay/border/find_border.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <stdexcept>

#include "src/delaunay/border/border_search.h"
#include "src/delaunay/border/conflict_region_batch.h"
#include "src/delaunay/border/facing_sides.h"
#include "src/delaunay/common/hash.h"
#include "src/geometry/dimensions.h"
#include "src/parallel/parallel.h"

namespace spillway::delaunay {
namespace {

constexpr std::size_t kCandidateGrain = 4096;

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
  FacingSides<D> sides(box);
  for (const Part<D>* part : siblings.parts) {
    if (!sides.add(part->box))
      throw std::logic_error("boxes of siblings that lie apart on no axis");
  }
  std::vector<std::vector<SimplexId>> found(grain_count(hull.size(), kCandidateGrain));
  parallel_for(
      hull.size(), kCandidateGrain, [&](std::size_t g, std::size_t begin, std::size_t end) {
        for (const SimplexId id : hull.subspan(begin, end - begin)) {
          if (sides.have_corner(triangulation.simplex(id).vertices, triangulation.points.span())) {
            found[g].push_back(id);
          }
        }
      });
  std::vector<SimplexId> all;
  for (const auto& some : found) all.insert(all.end(), some.begin(), some.end());
  return all;
}

/// A triangulation whose marks tell what has been found, for search_border().
template <int D>
class MarkedMesh {
 public:
  using Id = SimplexId;

  MarkedMesh(const Triangulation<D>& triangulation, std::span<ListMarks> marks)
      : triangulation_(triangulation), marks_(marks) {}

  [[nodiscard]] std::span<const Point<D>> positions() const { return triangulation_.points.span(); }
  [[nodiscard]] const auto& corners(Id id) const { return triangulation_.simplex(id).vertices; }
  [[nodiscard]] Id neighbour(Id id, int i) const { return triangulation_.neighbour(id, i); }
  [[nodiscard]] bool found(Id id) const {
    return mark(id).load(std::memory_order_relaxed) != Mark::kInterior;
  }
  [[nodiscard]] bool set_found(Id id) {
    return mark(id).exchange(Mark::kBorder, std::memory_order_relaxed) == Mark::kInterior;
  }

 private:
  [[nodiscard]] std::atomic_ref<Mark> mark(Id id) const {
    return std::atomic_ref<Mark>(marks_[id.list][id.index]);
  }

  const Triangulation<D>& triangulation_;
  std::span<ListMarks> marks_;
};

template <int D>
void add_leaves(const Part<D>& part, std::vector<std::uint32_t>& lists) {
  if (part.leaf()) lists.push_back(part.list);
  for (const Part<D>& child : part.children) add_leaves(child, lists);
}

}  // namespace

template <int D>
bool asking_for_points_pays(const Triangulation<D>& triangulation, const Part<D>& part,
                            const Siblings<D>& siblings) {
  std::vector<std::uint32_t> leaves;
  add_leaves(part, leaves);
  std::vector<std::array<VertexId, D + 1>> sample;
  for (std::size_t s = 0; s < kAskedSample; ++s) {
    const auto& simplices = triangulation.lists[leaves[s * leaves.size() / kAskedSample]].simplices;
    if (simplices.empty()) continue;
    const Simplex<D>& simplex = simplices[mix64(s) % simplices.size()];
    if (!simplex.removed()) sample.push_back(simplex.vertices);
  }
  return asking_for_points_pays<D>(sample, triangulation.points.span(), siblings);
}

template <int D>
std::vector<SimplexId> find_border(const Triangulation<D>& triangulation, const Box<D>& box,
                                   std::span<const SimplexId> hull, const Siblings<D>& siblings,
                                   std::span<ListMarks> marks) {
  MarkedMesh<D> mesh(triangulation, marks);
  return search_border<D>(beside_siblings<D>(triangulation, box, hull, siblings), mesh, [&] {
    return [search = PointSearch<D>(siblings)](const ConflictRegionBatch<D>& regions) mutable {
      return search.may_hold_points(regions, regions.all());
    };
  });
}

template <int D>
std::vector<SimplexId> border_among(const Triangulation<D>& triangulation, std::uint32_t list,
                                    std::span<const std::uint32_t> candidates,
                                    const Siblings<D>& siblings, std::span<ListMarks> marks) {
  ListMarks& mark = marks[list];
  const auto& simplices = triangulation.lists[list].simplices;
  parallel_for(
      candidates.size(), kCandidateGrain, [&](std::size_t, std::size_t begin, std::size_t end) {
        PointSearch<D> search(siblings);
        for_each_region_batch<D>(
            end - begin, [&](std::size_t s) { return simplices[candidates[begin + s]].vertices; },
            triangulation.points.span(),
            [&](std::size_t first, const ConflictRegionBatch<D>& regions) {
              std::uint64_t held = search.may_hold_points(regions, regions.all());
              for (; held != 0; held &= held - 1) {
                const int s = std::countr_zero(held);
                mark[candidates[begin + first + s]] =
                    regions.region(s).tight() ? Mark::kBorder : Mark::kVague;
              }
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

#define SPILLWAY_INSTANTIATE(D)                                                                  \
  template bool asking_for_points_pays<D>(const Triangulation<D>&, const Part<D>&,               \
                                          const Siblings<D>&);                                   \
  template std::vector<SimplexId> find_border<D>(const Triangulation<D>&, const Box<D>&,         \
                                                 std::span<const SimplexId>, const Siblings<D>&, \
                                                 std::span<ListMarks>);                          \
  template std::vector<SimplexId> border_among<D>(const Triangulation<D>&, std::uint32_t,        \
                                                  std::span<const std::uint32_t>,                \
                                                  const Siblings<D>&, std::span<ListMarks>);
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::delaunay
