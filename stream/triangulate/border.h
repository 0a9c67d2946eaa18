#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "src/delaunay/base_case/base_case.h"
#include "src/delaunay/division/point_tree.h"
#include "src/geometry/framed_point.h"
#include "src/geometry/point.h"
#include "src/parallel/parallel.h"
#include "src/runtime/work_lease.h"
#include "stream/output/stream_place.h"

namespace spillway::runtime {
struct Task;
}

namespace spillway::stream {

template <int D>
struct BorderVertex {
  Point<D> position;
  double height = 0;              ///< D = 2: z
  std::uint64_t input_index = 0;  ///< if vertices carry it
  StreamPlace place;
};

/// The vertex as a mesh has it, on the lattice. Its coordinates beyond z are among its attributes.
template <int D>
LatticePoint output_point(const BorderVertex<D>& vertex) {
  const Point<D>& position = vertex.position;
  if constexpr (D == 2) {
    return {position[0], position[1], vertex.height};
  } else {
    return {position[0], position[1], position[2]};
  }
}

/// Which merges above, within the same tile, may change a simplex: bit l is set if a sibling of the
/// part may, where l = 0, or of the l-th node above it.
using Exposure = std::uint16_t;
inline constexpr std::size_t kExposureLevels = 16;

/// What is left in memory of a part whose final simplices have been written: the simplices that
/// points elsewhere may still change, and their vertices.
template <int D>
struct Border {
  int dimension = -1;  ///< of the affine hull of all the part's points
  std::vector<BorderVertex<D>> vertices;
  std::vector<std::array<VertexId, D + 1>> simplices;  ///< of numbers of `vertices`
  std::vector<Exposure> exposure;     ///< by simplex, if it is known, as of most parts of tiles
  std::vector<std::byte> attributes;  ///< a record a vertex, if points carry any

  /// Whether the part has no simplices and gives all its points to the merge above, since they span
  /// fewer than D dimensions.
  [[nodiscard]] bool open() const { return dimension < D; }
  [[nodiscard]] std::vector<Point<D>> positions() const {
    constexpr std::size_t kGrain = 4096;
    std::vector<Point<D>> positions(vertices.size());
    parallel_for(positions.size(), kGrain, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) positions[v] = vertices[v].position;
    });
    return positions;
  }
  template <typename State>
  void state(State& state) {
    state(dimension, vertices, simplices, exposure, attributes);
  }
  [[nodiscard]] std::uint64_t bytes() const {
    return vertices.size() * sizeof(vertices[0]) + simplices.size() * sizeof(simplices[0]) +
           exposure.size() * sizeof(exposure[0]) + attributes.size();
  }
};

/// The simplices of a merge, in one numbering of the vertices of all its children.
template <int D>
struct MergedBorder {
  Border<D> border;
  std::size_t tested = 0;            ///< how many simplices in front are known not to be final
  bool exposure_is_known = true;     ///< of these
  std::uint64_t retriangulated = 0;  ///< points of the triangulation of the borders
  WorkLease memory;  ///< of the merge: enough to settle it, too, and to be given back then
};

/// Bytes of memory that are enough to triangulate `points` points, even if all of them stay in the
/// border to the end, where there are at most so many simplices for each. In the plane there are
/// two; in space there may be as many as there are points. Each carries attributes of `record_size`
/// bytes.
template <int D>
std::uint64_t enough_memory(std::uint64_t points, std::size_t record_size,
                            std::uint64_t simplices_a_point = 2);

/// Bytes of memory that are likely to be enough for `points` points if base cases go on as this
/// forecast of one says, whatever is divided: where many simplices meet in each point, the borders
/// of parts have nearly all points.
template <int D>
std::uint64_t enough_for(const WorkForecast& forecast, std::uint64_t points);

/// Bytes of memory for the triangulation of so many points of a border, where there are `below`
/// points below the merge.
template <int D>
std::uint64_t merge_bytes(std::uint64_t border_points, std::uint64_t below);

/// Makes one of the borders of parts that are children of one node. `trees[c]` is child c's tree of
/// points (Part or TileNode). The vertices of simplices that a sibling may change, and all vertices
/// of open children, are triangulated; of that, simplices are accepted that span children, or that
/// their own child has in its border, facing the same way (Funke, Sanders 2017, Algorithm 1). All
/// others of the children are kept as they are.
/// Leases the memory of that from `budget`, which must outlive the result; throws Failure if there is
/// not enough.
template <int D, PointTree Tree>
MergedBorder<D> merge_borders(std::span<Border<D>> children, std::span<const Tree* const> trees,
                              MemoryBudget& budget, Task& task, Kernel kernel = Kernel::kSpillway);

}  // namespace spillway::stream
