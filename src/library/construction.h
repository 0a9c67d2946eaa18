#pragma once
// From points of a program to the arrays of a mesh: what the constructor of spillway::Delaunay
// does.

#include <spillway/delaunay.h>

#include <cstddef>
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
  std::vector<Duplicate<Index>> duplicates;

  [[nodiscard]] MeshView<D, Index> view() const {
    return {span_of(points), span_of(cells.vertices), span_of(cells.neighbours),
            span_of(cells.vertex_cells)};
  }
};

/// Throws Error as the constructor of spillway::Delaunay says.
template <int D, class Index>
MeshData<D, Index> make_mesh(const PointView<D>& points, const DelaunayOptions& options);

/// Throws Error(kTooLarge) if there are more than `most` of these things.
void require_numbers(std::size_t count, std::size_t most, const std::string& things);

}  // namespace spillway::library
