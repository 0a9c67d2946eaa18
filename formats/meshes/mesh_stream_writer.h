#pragma once

#include <memory>
#include <string>

#include "formats/disk/scratch_folder.h"
#include "formats/meshes/common/mesh_format.h"

namespace spillway::formats {

/// Opens `path` ("-": standard output) for a mesh that comes block by block, in any format: those
/// whose headers come first are spooled in `scratch`, which must outlive the writer. The output's
/// files are created at once. Throws Failure as create_mesh_files() does.
std::unique_ptr<MeshStreamWriter> open_mesh_stream_writer(FileSystem& files,
                                                          const std::string& path,
                                                          const MeshFormat& format,
                                                          const MeshStreamHeader& header,
                                                          ScratchFolder& scratch);

}  // namespace spillway::formats
