#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "src/geometry/framed_point.h"
#include "src/geometry/point.h"
#include "stream/tiles/cuts/cut_tree.h"

namespace spillway::stream {

/// Some points of a sample in a cell, and the simplices of their triangulation that have all
/// corners in it. It tells what a cut would cross.
template <int D>
struct SampleMesh {
  std::vector<Point<D>> points;
  std::vector<double> weights;  ///< by point: its simplices, also those cut
  std::vector<std::array<VertexId, D + 1>> simplices{};  ///< by the numbers of their corners

  /// What is below a cut, and what is not. Simplices across it are in neither.
  [[nodiscard]] std::array<SampleMesh, 2> sides(const Cut& cut) const;
};

/// Triangulates `most` points of a sample, spread over it; fewer where they have many simplices,
/// since these may grow with the square of the points. Without simplices if the points do not span
/// D dimensions.
template <int D>
SampleMesh<D> triangulate_sample(std::span<const LatticePoint> sample, std::size_t most);

/// The first D coordinates.
template <int D>
Point<D> mesh_point(const LatticePoint& point);

}  // namespace spillway::stream
