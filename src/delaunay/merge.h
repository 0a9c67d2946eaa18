#pragma once

#include <functional>
#include <span>
#include <vector>

#include "src/delaunay/divide.h"
#include "src/delaunay/finality.h"
#include "src/delaunay/triangulation.h"

namespace spillway {

struct Task;

/// What merging needs to know of a part that is triangulated; its simplices are in the blocks of
/// its subtree.
struct PartSurface {
  int dimension = -1;              ///< of the affine hull of its points
  std::vector<SimplexId> hull;     ///< its infinite simplices, if dimension == D
  std::vector<VertexId> vertices;  ///< all its distinct vertices, sorted, if dimension < D
};

/// Triangulates a border's points for a merge of so many points; vertex v of the result is point
/// input_index[v] of those given.
template <int D>
using BorderTriangulator = std::function<Triangulation<D>(std::vector<Point<D>> points,
                                                          std::size_t part_size, Task& task)>;

/// Makes one triangulation of the parts that are `part`'s children (Algorithm 1 of Funke, Sanders
/// 2017, for any number of children at once):
///   1. The border of each child against its siblings is found; a child that spans fewer than D
///      dimensions gives all its points.
///   2. The vertices of all borders are triangulated.
///   3. Of that triangulation a simplex is accepted if it spans children, or if its own child's
///   border
///      has it too, facing the same way; border simplices that it does not have are removed.
///   4. Neighbours across the seams are linked, found by the hash of the facet they share.
/// New simplices go to block part.block, which must be empty; children's blocks stay where they
/// are. Returns the part's own surface. `task` gets the steps with their durations.
template <int D>
PartSurface merge(Triangulation<D>& triangulation, std::span<BlockMarks> marks, const Part<D>& part,
                  std::span<PartSurface> children, const BorderTriangulator<D>& triangulate_border,
                  Task& task);

}  // namespace spillway
