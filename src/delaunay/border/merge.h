#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "src/delaunay/border/find_border.h"
#include "src/delaunay/common/triangulation.h"
#include "src/delaunay/division/divide.h"

namespace spillway::runtime {
struct Task;
}

namespace spillway::delaunay {

/// What merging needs to know of a part that is done; its simplices are in the lists of its
/// subtree.
struct PartSurface {
  int dimension = -1;  ///< of the affine hull of its points
  /// Whether it has no simplices and gives all its vertices to the merge above: because they span
  /// fewer than D dimensions, or because nearly all its simplices would be in the border anyway.
  bool open = true;
  std::vector<SimplexId> hull;     ///< its infinite simplices; none if open
  std::vector<VertexId> vertices;  ///< all its distinct vertices, sorted, if open
  /// The numbers, ascending, of all simplices that points of other parts may change, and perhaps
  /// more, the hull among them. Known only of leaves.
  std::optional<std::vector<std::uint32_t>> changeable;
};

/// A border with more than this share of a part's points does not pay: such a part stays open, and
/// at the root, where that cannot be, the border is not divided again.
inline constexpr double kLargestBorder = 0.5;

/// Triangulates a border's points for a merge; vertex v of the result is point
/// input_index[v] of those given.
template <int D>
using BorderTriangulator =
    std::function<Triangulation<D>(SlabArray<Point<D>> points, std::size_t part_size, Task& task)>;

/// Makes one triangulation of the parts that are `part`'s children (Algorithm 1 of Funke, Sanders
/// 2017, for any number of children at once):
///   1. The border of each child against its siblings is found; an open child gives all its points.
///      If `may_stay_open` and the borders are more than kLargestBorder, that is all: the part
///      stays open, without vertices yet.
///   2. The vertices of all borders are triangulated.
///   3. Of that triangulation a simplex is accepted if it spans children, or if its own child's
///      border has it too, facing the same way; border simplices that it does not have are removed.
///   4. Neighbours across the seams are linked, found by the hash of the facet they share.
/// New simplices go to list part.list, which must be empty; children's lists stay where they
/// are. `boxes` has, by list, those of leaves. Returns the part's own surface. `task` gets the
/// steps with their durations.
template <int D>
PartSurface merge(Triangulation<D>& triangulation, std::span<ListMarks> marks,
                  std::span<const RunBoxes<D>> boxes, const Part<D>& part,
                  std::span<PartSurface> children, bool may_stay_open,
                  const BorderTriangulator<D>& triangulate_border, Task& task);

}  // namespace spillway::delaunay
