#pragma once

#include <memory>

#include "formats/disk/file_system.h"
#include "formats/meshes/common/mesh.h"
#include "formats/meshes/common/mesh_writer.h"

namespace spillway::detail {

/// Writes VTK's XML format for unstructured grids with appended raw data, as docs/formats-meshes.md
/// ("VTU") describes it. Holds the input indices, if there are any, in memory until all vertices
/// are written: 8 bytes a vertex.
std::unique_ptr<MeshWriter> open_vtu_writer(std::unique_ptr<OutputFile> file,
                                            const MeshHeader& header);

}  // namespace spillway::detail
