#pragma once

#include <memory>

#include "stream/ranks/mesh_output.h"

namespace spillway::ranks {

/// The output of a mesh in parts, as open_mesh_output() says.
std::unique_ptr<MeshOutput> open_part_files(FileSystem& files, const MeshTarget& target,
                                            const MeshStreamHeader& header, ScratchFolder& scratch,
                                            const distributed::Ranks& ranks);

}  // namespace spillway::ranks
