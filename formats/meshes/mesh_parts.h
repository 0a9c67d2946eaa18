#pragma once
// A mesh in several files: their names, and VTK's index of them. docs/formats-meshes.md ("Parts").

#include <string>
#include <vector>

#include "formats/meshes/common/mesh_writer.h"

namespace spillway::detail {

/// The extension of VTK's index.
inline constexpr const char* kPvtu = "pvtu";

/// The name of file `part`, from 0, of `parts` of the mesh `path`: its extension, if that is the
/// format's own or pvtu's, makes way for the number, with as many digits as the last one has, and
/// the format's extension.
std::string mesh_part_name(const std::string& path, MeshFormat format, int part, int parts);

/// The name of the index of the mesh `path`.
std::string pvtu_name(const std::string& path);

/// The index of the mesh `path` in `parts` files.
std::string pvtu_text(const std::string& path, int parts, bool has_input_index);

}  // namespace spillway::detail
