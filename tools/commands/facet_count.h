#pragma once

#include <cstdint>

#include "formats/meshes/common/mesh.h"

namespace spillway::detail {

/// Number of facets that belong to one simplex only: the hull's, in a complete triangulation.
std::uint64_t count_boundary_facets(const Mesh& mesh);

}  // namespace spillway::detail
