#include "src/library/point_location.h"

#include <algorithm>
#include <cstdint>

#include "src/geometry/distance.h"
#include "src/geometry/predicate_stages.h"
#include "src/geometry/predicates.h"
#include "src/library/distinct_queue.h"

namespace spillway::detail {
namespace {

/// On which side of the facet opposite the i-th corner of a cell the place lies: positive inside.
template <int D>
int side_of_facet(const std::array<Point<D>, D + 1>& corners, int i, const Point<D>& place) {
  std::array<Point<D>, D + 1> replaced = corners;
  replaced[i] = place;
  // The filter is inlined here; it nearly always decides.
  if (const auto sign = stages::filtered<stages::Orientation<D>>(replaced)) return *sign;
  return orientation<D>(replaced);
}

/// The lowest number of all cells that have a place on their boundary, found from one of them
/// across the facets that have it, too.
template <int D, class Index>
Index lowest_cell_around(const MeshView<D, Index>& mesh, const Point<D>& place, Index cell) {
  DistinctQueue<Index> cells;
  cells.add(cell);
  Index lowest = cell;
  for (std::size_t next = 0; next < cells.size(); ++next) {
    const Index current = cells[next];
    lowest = std::min(lowest, current);
    const auto corners = mesh.corners(current);
    for (int i = 0; i <= D; ++i) {
      const Index neighbour = mesh.neighbour(current, i);
      if (neighbour >= 0 && side_of_facet<D>(corners, i, place) == 0) cells.add(neighbour);
    }
  }
  return lowest;
}

/// The lowest number of all vertices as far from a place as `nearest`, which is the nearest. They
/// are the corners of a face of the Delaunay complex, hence joined by edges.
template <int D, class Index>
Index lowest_vertex_as_near(const MeshView<D, Index>& mesh, const Point<D>& place, Index nearest) {
  DistinctQueue<Index> vertices;
  vertices.add(nearest);
  Index lowest = nearest;
  for (std::size_t next = 0; next < vertices.size(); ++next) {
    const Index centre = vertices[next];
    lowest = std::min(lowest, centre);
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
  return lowest;
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

/// Where a walk ended, as far as it knows.
template <class Index>
struct Walk {
  Index last;                ///< the last cell
  bool outside = false;      ///< the place lies beyond a facet of it that is on the hull
  bool on_boundary = false;  ///< the place lies on its boundary
  Index vertex = -1;         ///< the vertex that the place is, if it is one
};

template <int D, class Index>
Walk<Index> walk(const MeshView<D, Index>& mesh, const Point<D>& place, Index start) {
  Index cell = start;
  Index from = -1;
  for (;;) {
    const auto corners = mesh.corners(cell);
    const auto corner = std::find(corners.begin(), corners.end(), place);
    if (corner != corners.end()) {
      const Index vertex = mesh.vertex(cell, static_cast<int>(corner - corners.begin()));
      return {.last = cell, .on_boundary = true, .vertex = vertex};
    }
    Index next = cell;
    bool on_boundary = false;
    for (int i = 0; i <= D; ++i) {
      const Index neighbour = mesh.neighbour(cell, i);
      if (neighbour >= 0 && neighbour == from) continue;  // the place is strictly on this side
      const int side = side_of_facet<D>(corners, i, place);
      if (side < 0) {
        next = neighbour;
        break;
      }
      on_boundary = on_boundary || side == 0;
    }
    if (next < 0) return {.last = cell, .outside = true};
    if (next == cell) return {.last = cell, .on_boundary = on_boundary};
    from = cell;
    cell = next;
  }
}

}  // namespace

template <int D, class Index>
Location<Index> locate(const MeshView<D, Index>& mesh, const Point<D>& place, Index start) {
  const Walk<Index> end = walk<D>(mesh, place, start);
  if (end.outside) return {-1, end.last};
  if (end.vertex >= 0) return {mesh.vertex_cells[end.vertex], end.last};
  if (!end.on_boundary) return {end.last, end.last};
  return {lowest_cell_around<D>(mesh, place, end.last), end.last};
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
  return step.ties ? lowest_vertex_as_near<D>(mesh, place, step.vertex) : step.vertex;
}

template Location<std::int32_t> locate<2>(const MeshView<2, std::int32_t>&, const Point<2>&,
                                          std::int32_t);
template Location<std::int32_t> locate<3>(const MeshView<3, std::int32_t>&, const Point<3>&,
                                          std::int32_t);
template Location<std::int64_t> locate<2>(const MeshView<2, std::int64_t>&, const Point<2>&,
                                          std::int64_t);
template Location<std::int64_t> locate<3>(const MeshView<3, std::int64_t>&, const Point<3>&,
                                          std::int64_t);
template std::int32_t nearest_vertex<2>(const MeshView<2, std::int32_t>&, const Point<2>&,
                                        std::int32_t);
template std::int32_t nearest_vertex<3>(const MeshView<3, std::int32_t>&, const Point<3>&,
                                        std::int32_t);
template std::int64_t nearest_vertex<2>(const MeshView<2, std::int64_t>&, const Point<2>&,
                                        std::int64_t);
template std::int64_t nearest_vertex<3>(const MeshView<3, std::int64_t>&, const Point<3>&,
                                        std::int64_t);

}  // namespace spillway::detail
