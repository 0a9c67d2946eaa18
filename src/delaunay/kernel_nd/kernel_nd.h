#pragma once

#include <span>

#include "src/delaunay/kernel_common/kernel.h"

namespace spillway::delaunay {

/// The own kernel for more than three dimensions: triangulates points that span D dimensions.
/// `basis` has the places of D + 1 affinely independent ones.
template <int D>
BaseCase<D> kernel_nd_base_case(const BaseCaseInput<D>& input, std::span<const VertexId> basis);

}  // namespace spillway::delaunay
