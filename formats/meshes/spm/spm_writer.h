#pragma once

#include <memory>

#include "formats/disk/file_system.h"
#include "formats/meshes/common/mesh_stream.h"

namespace spillway::formats {

/// Writes Spillway's own mesh stream to `file`, the header at once.
std::unique_ptr<MeshStreamWriter> open_spm_writer(std::unique_ptr<OutputFile> file,
                                                  const MeshStreamHeader& header);

}  // namespace spillway::formats
