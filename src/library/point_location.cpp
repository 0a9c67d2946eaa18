#include "src/library/point_location.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "src/geometry/dimensions.h"
#include "src/geometry/distance.h"
#include "src/geometry/predicate_stages.h"
#include "src/geometry/predicates.h"
#include "src/library/distinct_queue.h"
#include "src/parallel/parallel.h"

namespace spillway::library {
namespace {

/// Walks that take turns: while one waits for memory, the others go on. With half as many a place
/// takes a sixth longer, with twice as many no less.
constexpr std::size_t kWalkers = 8;
/// A walk begins with a search from afar, so it should go to some places.
constexpr std::size_t kFewestPlaces = 16;

/// On which side of the facet opposite the i-th corner of a cell the place lies: positive inside.
template <int D>
int side_of_facet(const std::array<Point<D>, D + 1>& corners, int i, const Point<D>& place) {
  std::array<Point<D>, D + 1> replaced = corners;
  replaced[i] = place;
  // The filter is inlined here; it nearly always decides.
  if (const auto sign = stages::filtered<stages::Orientation<D>>(replaced)) return *sign;
  return orientation<D>(replaced);
}

/// The lowest number of all cells that have a place on their boundary, one of which is given.
template <int D, class Index>
Index lowest_cell_around(const MeshView<D, Index>& mesh, const Point<D>& place, Index cell) {
  return std::ranges::min(cells_around<D>(mesh, place, cell));
}

template <typename T>
std::vector<T> items_of(const DistinctQueue<T>& queue) {
  std::vector<T> items;
  for (std::size_t i = 0; i < queue.size(); ++i) items.push_back(queue[i]);
  return items;
}

/// A vertex and one of its cells, on the way to the nearest.
template <class Index>
struct Step {
  Index vertex;
  Index cell;
  bool ties = false;  ///< whether others are as near
};

/// Looks through the star of a vertex for one that is nearer to the place. If there is none the
/// step stays where it is and knows of ties.
template <int D, class Index>
bool go_nearer(const MeshView<D, Index>& mesh, const Point<D>& place, Step<Index>& step) {
  const Point<D>& centre = mesh.points[step.vertex];
  bool ties = false;
  const auto is_nearer = [&](Index vertex, Index cell) {
    const int sign = compare_distances<D>(place, mesh.points[vertex], centre);
    ties = ties || sign == 0;
    if (sign < 0) step = {vertex, cell};
    return sign < 0;
  };
  DistinctQueue<Index> star;
  star.add(step.cell);
  for (int i = 0; i <= D; ++i) {
    const Index vertex = mesh.vertex(step.cell, i);
    if (vertex != step.vertex && is_nearer(vertex, step.cell)) return true;
  }
  for (std::size_t c = 0; c < star.size(); ++c) {
    const Index cell = star[c];
    for (int i = 0; i <= D; ++i) {
      const Index neighbour = mesh.neighbour(cell, i);
      if (neighbour < 0 || mesh.vertex(cell, i) == step.vertex || !star.add(neighbour)) continue;
      // All its vertices but one are the cell's, too.
      const int place_there = mesh.place_of_neighbour(neighbour, cell);
      if (is_nearer(mesh.vertex(neighbour, place_there), neighbour)) return true;
    }
  }
  step.ties = ties;
  return false;
}

/// A visibility walk to a place.
template <int D, class Index>
struct Walk {
  Point<D> place;
  Index cell;                ///< where it is
  Index from = -1;           ///< the cell before: the place is strictly on this side of it
  bool outside = false;      ///< the place lies beyond a facet of the cell that is on the hull
  bool on_boundary = false;  ///< the place lies on the cell's boundary
  Index vertex = -1;         ///< the vertex that the place is, if it is one
};

/// Goes to the next cell. Returns false if the walk has come to its end.
template <int D, class Index>
bool go_on(const MeshView<D, Index>& mesh, Walk<D, Index>& walk) {
  const auto corners = mesh.corners(walk.cell);
  const auto corner = std::find(corners.begin(), corners.end(), walk.place);
  if (corner != corners.end()) {
    walk.vertex = mesh.vertex(walk.cell, static_cast<int>(corner - corners.begin()));
    return false;
  }
  for (int i = 0; i <= D; ++i) {
    const Index neighbour = mesh.neighbour(walk.cell, i);
    if (neighbour >= 0 && neighbour == walk.from) continue;
    const int side = side_of_facet<D>(corners, i, walk.place);
    if (side < 0) {
      walk.outside = neighbour < 0;
      if (walk.outside) return false;
      walk.from = std::exchange(walk.cell, neighbour);
      walk.on_boundary = false;
      return true;
    }
    walk.on_boundary = walk.on_boundary || side == 0;
  }
  return false;
}

template <int D, class Index>
Location<Index> end_of(const MeshView<D, Index>& mesh, const Walk<D, Index>& walk) {
  if (walk.outside) return {-1, walk.cell};
  if (walk.vertex >= 0) return {mesh.vertex_cells[walk.vertex], walk.cell};
  if (!walk.on_boundary) return {walk.cell, walk.cell};
  return {lowest_cell_around<D>(mesh, walk.place, walk.cell), walk.cell};
}

template <int D, class Index>
void fetch_cell(const MeshView<D, Index>& mesh, Index cell) {
  const std::size_t first = static_cast<std::size_t>(cell) * (D + 1);
  __builtin_prefetch(&mesh.vertices[first]);
  __builtin_prefetch(&mesh.neighbours[first]);
}

template <int D, class Index>
void fetch_corners(const MeshView<D, Index>& mesh, Index cell) {
  for (int i = 0; i <= D; ++i) __builtin_prefetch(&mesh.points[mesh.vertex(cell, i)]);
}

/// Walks to some places, one after the other.
template <int D, class Index>
struct Walker {
  std::size_t now, end;  ///< numbers of places
  Walk<D, Index> walk;
  bool has_corners = false;  ///< whether those of the cell have been fetched
};

}  // namespace

template <int D, class Index>
std::vector<Index> cells_around(const MeshView<D, Index>& mesh, const Point<D>& place, Index cell) {
  DistinctQueue<Index> cells;
  cells.add(cell);
  for (std::size_t next = 0; next < cells.size(); ++next) {
    const Index current = cells[next];
    const auto corners = mesh.corners(current);
    for (int i = 0; i <= D; ++i) {
      const Index neighbour = mesh.neighbour(current, i);
      if (neighbour >= 0 && side_of_facet<D>(corners, i, place) == 0) cells.add(neighbour);
    }
  }
  return items_of(cells);
}

/// They are the corners of a face of the Delaunay complex, hence joined by edges.
template <int D, class Index>
std::vector<Index> vertices_as_near(const MeshView<D, Index>& mesh, const Point<D>& place,
                                    Index nearest) {
  DistinctQueue<Index> vertices;
  vertices.add(nearest);
  for (std::size_t next = 0; next < vertices.size(); ++next) {
    const Index centre = vertices[next];
    DistinctQueue<Index> star;
    star.add(mesh.vertex_cells[centre]);
    for (std::size_t c = 0; c < star.size(); ++c) {
      for (int i = 0; i <= D; ++i) {
        const Index vertex = mesh.vertex(star[c], i);
        if (vertex == centre) continue;
        const Index neighbour = mesh.neighbour(star[c], i);
        if (neighbour >= 0) star.add(neighbour);
        if (compare_distances<D>(place, mesh.points[vertex], mesh.points[centre]) == 0) {
          vertices.add(vertex);
        }
      }
    }
  }
  return items_of(vertices);
}

template <int D, class Index>
Location<Index> locate(const MeshView<D, Index>& mesh, const Point<D>& place, Index start) {
  Walk<D, Index> walk{place, start};
  while (go_on<D>(mesh, walk)) {
  }
  return end_of<D>(mesh, walk);
}

template <int D, class Index>
std::vector<Location<Index>> locate_all(const MeshView<D, Index>& mesh,
                                        const StartTree<D, Index>& starts,
                                        std::span<const Point<D>> places) {
  std::vector<Location<Index>> found(places.size());
  std::vector<Walker<D, Index>> walkers;
  const std::size_t share = std::max(kFewestPlaces, grain_count(places.size(), kWalkers));
  for (std::size_t first = 0; first < places.size(); first += share) {
    const Index start = starts.find(places[first]);
    walkers.push_back({first, std::min(places.size(), first + share), {places[first], start}});
    fetch_cell<D>(mesh, start);
  }
  while (!walkers.empty()) {
    for (std::size_t w = 0; w < walkers.size(); ++w) {
      Walker<D, Index>& walker = walkers[w];
      if (!std::exchange(walker.has_corners, true)) {
        fetch_corners<D>(mesh, walker.walk.cell);
      } else if (go_on<D>(mesh, walker.walk)) {
        fetch_cell<D>(mesh, walker.walk.cell);
        walker.has_corners = false;
      } else {
        found[walker.now] = end_of<D>(mesh, walker.walk);
        if (++walker.now < walker.end) {
          walker.walk = {places[walker.now], walker.walk.cell};
        } else {
          walker = walkers.back();
          walkers.pop_back();
        }
      }
    }
  }
  return found;
}

template <int D, class Index>
Index nearest_vertex(const MeshView<D, Index>& mesh, const Point<D>& place, Index start) {
  Step<Index> step{mesh.vertex(start, 0), start};
  for (int i = 1; i <= D; ++i) {
    const Index vertex = mesh.vertex(start, i);
    if (compare_distances<D>(place, mesh.points[vertex], mesh.points[step.vertex]) < 0) {
      step.vertex = vertex;
    }
  }
  while (go_nearer<D>(mesh, place, step)) {
  }
  return step.ties ? std::ranges::min(vertices_as_near<D>(mesh, place, step.vertex)) : step.vertex;
}

#define SPILLWAY_INSTANTIATE_INDEX(D, Index)                                                      \
  template std::vector<Index> cells_around<D>(const MeshView<D, Index>&, const Point<D>&, Index); \
  template std::vector<Index> vertices_as_near<D>(const MeshView<D, Index>&, const Point<D>&,     \
                                                  Index);
#define SPILLWAY_INSTANTIATE(D)               \
  SPILLWAY_INSTANTIATE_INDEX(D, std::int32_t) \
  SPILLWAY_INSTANTIATE_INDEX(D, std::int64_t)
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE
#undef SPILLWAY_INSTANTIATE_INDEX

#define SPILLWAY_INSTANTIATE(D)                                                                 \
  template Location<std::int32_t> locate<D>(const MeshView<D, std::int32_t>&, const Point<D>&,  \
                                            std::int32_t);                                      \
  template Location<std::int64_t> locate<D>(const MeshView<D, std::int64_t>&, const Point<D>&,  \
                                            std::int64_t);                                      \
  template std::vector<Location<std::int32_t>> locate_all<D>(const MeshView<D, std::int32_t>&,  \
                                                             const StartTree<D, std::int32_t>&, \
                                                             std::span<const Point<D>>);        \
  template std::int32_t nearest_vertex<D>(const MeshView<D, std::int32_t>&, const Point<D>&,    \
                                          std::int32_t);                                        \
  template std::vector<Location<std::int64_t>> locate_all<D>(const MeshView<D, std::int64_t>&,  \
                                                             const StartTree<D, std::int64_t>&, \
                                                             std::span<const Point<D>>);        \
  template std::int64_t nearest_vertex<D>(const MeshView<D, std::int64_t>&, const Point<D>&,    \
                                          std::int64_t);
SPILLWAY_FOR_EACH_DIMENSION(SPILLWAY_INSTANTIATE)
#undef SPILLWAY_INSTANTIATE

}  // namespace spillway::library
