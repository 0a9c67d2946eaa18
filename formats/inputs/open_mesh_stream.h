#pragma once

#include <memory>
#include <string>

#include "formats/disk/file_system.h"
#include "formats/meshes/common/mesh_stream.h"

namespace spillway::detail {

/// Opens "spm" or "sma" (by `format_name`, else by the first bytes, so that pipes work) for
/// reading; "-" is standard input. Throws Error for anything else.
std::unique_ptr<MeshStreamReader> open_mesh_stream_reader(FileSystem& files,
                                                          const std::string& path,
                                                          const std::string& format_name = "");

}  // namespace spillway::detail
