#pragma once

#include <memory>

#include "formats/disk/file_system.h"
#include "formats/meshes/common/mesh_stream.h"

namespace spillway::formats {

/// Writes the ASCII streaming mesh of Isenburg and Lindstrom to `file`: triangles, without an input
/// index. docs/formats-meshes.md ("SMA").
std::unique_ptr<MeshStreamWriter> open_sma_writer(std::unique_ptr<OutputFile> file,
                                                  const MeshStreamHeader& header);

}  // namespace spillway::formats
