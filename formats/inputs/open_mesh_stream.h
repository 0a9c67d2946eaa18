#pragma once

#include <memory>
#include <string>

#include "formats/bytes/input_bytes.h"
#include "formats/disk/file_system.h"
#include "formats/meshes/mesh_formats.h"

namespace spillway::formats {

/// The format of streams that the source has by its first bytes, which stay unread, or by its path.
/// Throws Failure if neither tells one.
const MeshFormat& mesh_stream_format(InputBytes& source, const std::string& path,
                                     MeshFormats formats = mesh_formats());

/// Opens a format of streams (by `format_name`, else by the first bytes, so that pipes work) for
/// reading; "-" is standard input. Throws Failure for any other.
std::unique_ptr<MeshStreamReader> open_mesh_stream_reader(FileSystem& files,
                                                          const std::string& path,
                                                          const std::string& format_name = "",
                                                          MeshFormats formats = mesh_formats());

}  // namespace spillway::formats
