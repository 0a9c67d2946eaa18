#pragma once

#include <span>
#include <vector>

#include "src/library/mesh_view.h"
#include "src/library/start_tree.h"

namespace spillway::library {

/// Where a search for a place ended.
template <class Index>
struct Location {
  Index cell;  ///< the lowest number of a cell that has the place, -1 outside of the hull
  Index last;  ///< the last cell of the walk: `cell` or one beside it, or one on the hull
};

/// Finds a place by a visibility walk from cell to cell (Devillers, Pion, Teillaud, "Walking in a
/// triangulation", Int. J. Found. Comput. Sci. 13 (2002)), which ends in every Delaunay
/// triangulation. Signs are exact, and of several cells with the place the lowest number counts, so
/// the answer does not depend on `start`. The place must be finite.
template <int D, class Index>
Location<Index> locate(const MeshView<D, Index>& mesh, const Point<D>& place, Index start);

/// The same for many finite places, which are to lie near each other in their order. Several walks
/// take turns, since a walk alone spends most of its time waiting for memory.
template <int D, class Index>
std::vector<Location<Index>> locate_all(const MeshView<D, Index>& mesh,
                                        const StartTree<D, Index>& starts,
                                        std::span<const Point<D>> places);

/// All cells that have a place inside or on their boundary, found from one of them across the
/// facets that have it, too.
template <int D, class Index>
std::vector<Index> cells_around(const MeshView<D, Index>& mesh, const Point<D>& place, Index cell);

/// All vertices as far from a place as `nearest`, which is the nearest.
template <int D, class Index>
std::vector<Index> vertices_as_near(const MeshView<D, Index>& mesh, const Point<D>& place,
                                    Index nearest);

/// The vertex nearest to a place, the lowest number of several. `start` is any cell; a near one
/// saves time. Goes from vertex to nearer vertex along edges: where none is nearer, none in the
/// mesh is, since a vertex's Voronoi cell is bounded by the bisectors to its neighbours.
template <int D, class Index>
Index nearest_vertex(const MeshView<D, Index>& mesh, const Point<D>& place, Index start);

}  // namespace spillway::library
