#pragma once

#include <string>
#include <vector>

#include "src/delaunay/common/triangulation.h"

namespace spillway::test {

/// Checks a triangulation from first principles: vertex numbers in range, every neighbour relation
/// symmetric across a common facet, every finite simplex positively oriented, each facet locally
/// Delaunay with the perturbed predicate, Euler's relation (D <= 3), the hull complete and convex.
/// Returns what is wrong, one line a fault (at most ten), or nothing. Time and memory are not
/// tuned.
template <int D>
std::vector<std::string> verify(const Triangulation<D>& triangulation);

}  // namespace spillway::test
