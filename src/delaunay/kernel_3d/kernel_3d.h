#pragma once
// The base case in space: exact incremental insertion along a Hilbert curve, in rounds. How it
// works and why it is exact: docs/algorithm-kernel-3d.md.

#include <span>

#include "src/delaunay/kernel_common/kernel.h"

namespace spillway::delaunay {

/// Triangulates points that span space; `basis` has the places of four that are not coplanar. Works
/// for any finite doubles. Throws Failure for more than 2^28 - 2 points, or if there are more than
/// 2^28 cells, which is more than it can number: those of some 39 million scattered points.
BaseCase<3> kernel_3d_base_case(const BaseCaseInput<3>& input, std::span<const VertexId> basis);

}  // namespace spillway::delaunay
