#pragma once
// Of the cells of a triangulation of copies of points, those of the flat torus.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "src/delaunay/common/slab_array.h"
#include "src/geometry/periodic_domain.h"
#include "src/library/cell_arrays.h"
#include "src/library/mesh_view.h"

namespace spillway::library {

/// The points of a box and their copies within a margin, triangulated.
template <int D, class Index>
struct CopiesView {
  MeshView<D, Index> mesh;          ///< the points of the box come first, in their order
  std::size_t points;               ///< so many
  std::span<const Index> point_of;  ///< by point of `mesh`: which one it is a copy of
};

/// The cells of a flat torus.
template <int D, class Index>
struct TorusCells {
  /// What was made is the triangulation of the torus, and queries find what they should. If not, the
  /// margin is too narrow and all else but `reach` has no meaning.
  bool proven = false;
  std::array<double, 3> reach{};  ///< the longest that a cell is along each periodic axis

  /// Copies of points without which some copies of cells that meet the box are not there. None if
  /// the margin is too narrow for anything else.
  std::vector<Point<D>> missing;
  std::vector<Index> missing_of;  ///< which points they are copies of

  CellArrays<Index> cells;
  SlabArray<std::int8_t> offsets;
  std::vector<Index> kept;    ///< by cell: the cell of the copies whose centre lies in the box
  std::vector<Index> number;  ///< by cell of the copies that meets the box: its cell; or -1
};

/// Chooses of all copies of a cell the one whose centre lies in the box. Proves that
///   - no sphere of a chosen cell reaches beyond the copies, so that all are Delaunay cells of the
///     torus;
///   - each of their facets has a chosen cell on its other side, or is one of the hull of all
///     copies, so that none is missing;
///   - all copies of them that meet the box are there, so that places in the box are found;
///   - no place in the box is farther than the margin from its nearest point.
/// Made by the threads of with_threads().
template <int D, class Index>
TorusCells<D, Index> choose_torus_cells(const PeriodicDomain& domain,
                                        const CopiesView<D, Index>& copies);

}  // namespace spillway::library
