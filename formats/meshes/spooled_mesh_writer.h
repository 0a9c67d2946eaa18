#pragma once

#include <cstddef>
#include <memory>

#include "formats/disk/scratch_folder.h"
#include "formats/meshes/common/mesh_format.h"
#include "formats/meshes/spool/mesh_spool.h"

namespace spillway::formats {

/// Writes a mesh in a format whose counts come first: blocks are spooled, encoded as in spm, and
/// finish() reads the spool twice, for vertices and for simplices. A spool of at most `memory`
/// bytes never touches the disk. `scratch` must outlive the writer.
std::unique_ptr<MeshStreamWriter> open_spooled_mesh_writer(MeshFiles files,
                                                           const MeshStreamHeader& header,
                                                           ScratchFolder& scratch,
                                                           std::size_t memory = kSpoolMemory);

}  // namespace spillway::formats
