#pragma once

#include <memory>

#include "formats/disk/file_system.h"
#include "formats/meshes/common/mesh_stream.h"

namespace spillway::formats {

/// Begins a binary STL file: float32 coordinates from an origin near the first vertex, which the
/// header names, and normals. Throws Failure for a file that cannot go back to its header.
std::unique_ptr<MeshStreamWriter> open_stl_writer(std::unique_ptr<OutputFile> file,
                                                  const MeshStreamHeader& header);

}  // namespace spillway::formats
