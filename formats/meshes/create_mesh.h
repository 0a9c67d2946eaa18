#pragma once

#include <memory>
#include <string>

#include "formats/disk/file_system.h"
#include "formats/meshes/common/mesh_format.h"

namespace spillway::formats {

/// Throws Failure if the format cannot hold that.
void check_holds(const MeshFormat& format, const std::string& path, const MeshContents& contents);

/// Creates the files of the mesh `path` ("-": standard output). Throws Failure if the format cannot
/// hold it (MeshFormat tells), if it needs two files or one that it can go back in and gets
/// standard output, or if a file cannot be created.
MeshFiles create_mesh_files(FileSystem& files, const std::string& path, const MeshFormat& format,
                            const MeshContents& contents);

/// Begins to write to these files. Throws Failure for what is written block by block:
/// open_mesh_stream_writer() does that.
std::unique_ptr<MeshWriter> open_mesh_writer(MeshFiles files, const MeshFileHeader& header);

/// Creates the files of a mesh and begins to write to them.
std::unique_ptr<MeshWriter> open_mesh_writer(FileSystem& files, const std::string& path,
                                             const MeshFormat& format,
                                             const MeshFileHeader& header);

}  // namespace spillway::formats
