#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "src/geometry/framed_point.h"
#include "stream/tiles/cuts/cut_tree.h"

namespace spillway::stream {

/// The cuts that divide space into about `parts` parts with equally many points, of a sample of
/// all. A cut is across the longest side of a cell, unless a triangulation of some of the sample
/// says that another one is crossed by fewer simplices: these become the border between parts. A
/// cut moves by a few percent of the points to where fewer cross it. (After Funke, Sanders,
/// Winkler, "Load-Balancing for Parallel Delaunay Triangulations", Euro-Par 2019, who cut the graph
/// of a sample's triangulation into parts of any shape; here all cuts are across an axis.) Fewer
/// parts come out where the sample's points are equal or fewer than these. The same sample in the
/// same order gives the same cuts.
///
/// Tried and left out: parts of equal work, as told by how many simplices the points have. In space
/// that is nearly the same for all points, but where lines and curves are. There all that is cut is
/// border, and to divide it costs more than it balances.
template <int D>
std::vector<DivisionCut> divide_sample(std::span<const LatticePoint> sample, std::size_t parts);

/// The same in a dimension that is not known before.
std::vector<DivisionCut> divide_sample(std::span<const LatticePoint> sample, std::size_t parts,
                                       int dimension);

/// The cuts that divide space into about `parts` parts with equally many points of a sample, each
/// across the longest side of a cell. Fewer come out where the sample's points are equal.
std::vector<DivisionCut> divide_sample_evenly(std::span<const LatticePoint> sample,
                                              std::size_t parts, int dimension);

}  // namespace spillway::stream
