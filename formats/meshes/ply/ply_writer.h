#pragma once

#include <memory>

#include "formats/disk/file_system.h"
#include "formats/meshes/common/mesh.h"
#include "formats/meshes/common/mesh_writer.h"

namespace spillway::formats {

/// Writes PLY 1.0 with double coordinates, binary little-endian or ASCII, as docs/formats-meshes.md
/// ("PLY") describes it. Throws Failure for more than 2^32 vertices, which PLY cannot number.
std::unique_ptr<MeshWriter> open_ply_writer(std::unique_ptr<OutputFile> file,
                                            const MeshFileHeader& header, bool ascii);

}  // namespace spillway::formats
