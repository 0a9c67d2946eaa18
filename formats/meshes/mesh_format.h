#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "formats/meshes/common/mesh_writer.h"

namespace spillway::detail {

/// All names of mesh formats, as the command line lists them: "ply", "ply-ascii", "obj", ...
std::vector<std::string> mesh_format_names();

/// The format called `format_name`, or, if that is empty, the one of the path's extension; "spm"
/// for standard output. Throws InvalidArgument that lists what there is if neither names a format.
MeshFormat mesh_format(const std::string& path, const std::string& format_name);

/// What is to be said of a mesh in a format that rounds its coordinates; empty for others.
std::string rounding_note(MeshFormat format);

/// What the formats of triangles only are called in messages; empty for the others.
std::string_view triangle_format(MeshFormat format);

}  // namespace spillway::detail
