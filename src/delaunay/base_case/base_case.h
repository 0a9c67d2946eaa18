#pragma once

#include <span>

#include "src/delaunay/common/triangulation.h"
#include "src/delaunay/kernel_common/kernel.h"

namespace spillway::delaunay {

/// Triangulates any finite points: none, one, all equal, collinear, coplanar or in general
/// position. The calling thread does so alone, but those of with_threads() that have nothing else
/// to do help it to list many simplices.
template <int D>
BaseCase<D> triangulate_base_case(const BaseCaseInput<D>& input);

/// A kernel for D <= 3: triangulates points that span D dimensions. `basis` has the places of D+1
/// affinely independent ones.
template <int D>
BaseCase<D> cgal_base_case(const BaseCaseInput<D>& input, std::span<const VertexId> basis);

/// Gives the system the memory that base cases keep for those that follow.
void release_base_case_memory();

/// The same of what is larger than base cases of so many points use, and was left by larger ones.
template <int D>
void release_base_case_memory_above(std::size_t points);

}  // namespace spillway::delaunay
