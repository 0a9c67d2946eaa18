#pragma once
// From a block's own numbers and coordinates to those of the whole mesh.

#include <cstdint>
#include <vector>

#include "formats/meshes/common/mesh.h"
#include "formats/meshes/common/mesh_stream.h"

namespace spillway::detail {

/// Appends the corners of a block's simplices as stream numbers, where the block's vertices are
/// numbered from `first` on.
void append_stream_numbers(const MeshBlock& block, std::uint64_t first,
                           std::vector<std::uint64_t>& corners);

/// What a mesh file says of the whole that the stream has become.
MeshHeader header_of_mesh(const MeshStreamHeader& header, const MeshTotals& totals);

/// Maps the vertices of a block to output coordinates.
void move_to_world(const MeshStreamHeader& header, MeshBlock& block);

}  // namespace spillway::detail
