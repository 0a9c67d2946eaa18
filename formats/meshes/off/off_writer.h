#pragma once

#include <memory>

#include "formats/disk/file_system.h"
#include "formats/meshes/common/mesh.h"
#include "formats/meshes/common/mesh_writer.h"

namespace spillway::formats {

/// Writes triangles as OFF, as docs/formats-meshes.md ("OFF") describes it.
std::unique_ptr<MeshWriter> open_off_writer(std::unique_ptr<OutputFile> file,
                                            const MeshFileHeader& header);

}  // namespace spillway::formats
