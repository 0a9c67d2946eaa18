#pragma once
// VTK's index of a mesh in parts (.pvtu): docs/formats-meshes.md ("Parts").

#include <span>
#include <string>

#include "formats/bytes/input_bytes.h"
#include "formats/meshes/common/mesh_stream.h"

namespace spillway::formats {

/// The index of the parts of these names, of a mesh with this header.
std::string pvtu_text(std::span<const std::string> names, const MeshStreamHeader& header);

/// Throws Failure if this is such an index.
void check_is_no_pvtu(InputBytes& source);

}  // namespace spillway::formats
