#pragma once
// The base case in the plane: exact incremental insertion along a Hilbert curve, in rounds. How it
// works and why it is exact: docs/algorithm-kernel-2d.md.

#include <span>

#include "src/delaunay/kernel_common/kernel.h"

namespace spillway::delaunay {

/// Triangulates points that span the plane; `basis` has the places of three that are not collinear.
/// Works for any finite doubles. Throws Failure for more than 2^27 - 1 points, whose triangles are
/// more than it can number.
BaseCase<2> kernel_2d_base_case(const BaseCaseInput<2>& input, std::span<const VertexId> basis);

}  // namespace spillway::delaunay
