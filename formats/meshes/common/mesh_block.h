#pragma once
// From a block's own numbers and coordinates to those of the whole mesh.

#include <cstdint>
#include <optional>
#include <vector>

#include "formats/meshes/common/mesh.h"
#include "formats/meshes/common/mesh_stream.h"

namespace spillway::formats {

/// Appends the corners of a block's simplices as stream numbers, where the block's vertices are
/// numbered from `first` on.
void append_stream_numbers(const MeshStreamBlock& block, std::uint64_t first,
                           std::vector<std::uint64_t>& corners);

/// What a mesh file says of the whole that the stream has become.
MeshFileHeader header_of_mesh(const MeshStreamHeader& header, const MeshTotals& totals);

/// The vertices of a mesh as a stream with this lattice has them, whose first `axes` axes are
/// integers; nothing if a vertex is not on it.
std::optional<std::vector<LatticePoint>> vertices_on_lattice(const Mesh& mesh,
                                                             const IntegerLattice& lattice,
                                                             int axes);

/// The same for a stream without a lattice.
std::vector<LatticePoint> vertices_without_lattice(const Mesh& mesh);

/// The vertices of a block in output coordinates.
std::vector<WorldPoint> world_vertices(const MeshStreamHeader& header,
                                       const MeshStreamBlock& block);

}  // namespace spillway::formats
