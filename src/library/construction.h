#pragma once
// From points of a program to the arrays of a mesh: what the constructor of spillway::Delaunay
// does.

#include <spillway/delaunay.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "src/delaunay/common/slab_array.h"
#include "src/library/cell_arrays.h"
#include "src/library/mesh_view.h"

namespace spillway::library {

/// What a triangulation is made into.
template <int D, class Index>
struct MeshData {
  unsigned threads = 1;
  SlabArray<Point<D>> points;
  CellArrays<Index> cells;
  SlabArray<std::int8_t> offsets{};  ///< of a periodic mesh
  std::vector<Duplicate<Index>> duplicates;

  [[nodiscard]] MeshView<D, Index> view() const {
    return {span_of(points), span_of(cells.vertices), span_of(cells.neighbours),
            span_of(cells.vertex_cells)};
  }
};

/// The points alone, and how many threads are to work. Throws Error as the constructor of
/// spillway::Delaunay says, which make_cells() and make_mesh() do, too.
template <int D, class Index>
MeshData<D, Index> copy_points(const PointView<D>& points, const DelaunayOptions& options);

/// Triangulates the points. `points` is the number that messages tell.
template <int D, class Index>
void make_cells(MeshData<D, Index>& mesh, std::size_t points, const DelaunayOptions& options);

/// Both.
template <int D, class Index>
MeshData<D, Index> make_mesh(const PointView<D>& points, const DelaunayOptions& options);

/// Throws Error(kTooLarge) if there are more of these things than points may be.
template <class Index>
void require_point_numbers(std::size_t count, const std::string& things);

/// Throws Error(kTooLarge) if there are more than `most` of these things.
void require_numbers(std::size_t count, std::size_t most, const std::string& things);

}  // namespace spillway::library
