#pragma once

#include <cstddef>
#include <vector>

#include "formats/meshes/common/mesh_stream.h"

namespace spillway::formats {

/// A block that is a whole mesh, with `corners` a simplex and records of `record_size`, as blocks
/// of `size` vertices that import from each other. Vertices stay in their order; a simplex comes as
/// soon as its vertices have, and each vertex is finalized where it is used last.
std::vector<MeshStreamBlock> divided(const MeshStreamBlock& whole, std::size_t corners,
                                     std::size_t record_size, std::size_t size);

}  // namespace spillway::formats
