#pragma once

#include <memory>

#include "formats/disk/file_system.h"
#include "formats/meshes/common/mesh.h"
#include "formats/meshes/common/mesh_writer.h"

namespace spillway::formats {

/// Begins a binary glTF file: float32 positions from an origin near the first vertex, which a node
/// adds, within a node that turns z up to glTF's y up. Throws Failure if the mesh is too large for
/// the format (4 GiB in all) or the file cannot go back to its header.
std::unique_ptr<MeshWriter> open_glb_writer(std::unique_ptr<OutputFile> file,
                                            const MeshFileHeader& header);

}  // namespace spillway::formats
