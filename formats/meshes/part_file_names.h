#pragma once
// A mesh in several files, one of each rank: docs/formats-meshes.md ("Parts").

#include <string>

#include "formats/meshes/common/mesh_format.h"

namespace spillway::formats {

/// The name of file `part`, from 0, of `parts` of the mesh `path`: its extension, if that is the
/// format's own or that of its index, makes way for the number, with as many digits as the last one
/// has, and the format's extension.
std::string part_file_name(const std::string& path, const MeshFormat& format, int part, int parts);

/// The name of the index of the mesh `path`, of a format that has one.
std::string part_index_name(const std::string& path, const MeshFormat& format);

/// That index of so many parts of a mesh with this header.
std::string part_index_text(const std::string& path, const MeshFormat& format, int parts,
                            const MeshStreamHeader& header);

}  // namespace spillway::formats
