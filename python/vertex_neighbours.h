#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace spillway::python {

/// Which vertices have an edge in common with each point: those of point p, ascending, are
/// `indices` from starts[p] to starts[p + 1]. Points that are no vertices have none.
template <class Index>
struct VertexNeighbours {
  std::vector<Index> starts;  ///< one more than there are points
  std::vector<Index> indices;
};

/// Of cells of `corners` vertices each, one after the other. Throws Error(kTooLarge) if there are
/// more neighbours than an Index can number.
template <class Index>
VertexNeighbours<Index> vertex_neighbours(std::span<const Index> cell_vertices, std::size_t corners,
                                          std::size_t points);

}  // namespace spillway::python
