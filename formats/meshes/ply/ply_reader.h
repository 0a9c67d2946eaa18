#pragma once

#include "formats/bytes/input_bytes.h"
#include "formats/meshes/common/mesh.h"

namespace spillway::formats {

/// Reads a PLY mesh, binary of either byte order or ASCII. Other numbers of vertices
/// become attributes; elements and lists that are not the mesh's are passed over, faces too where
/// there are tetrahedra. Throws Failure that names the item and its byte or line.
Mesh read_ply(InputBytes& source);

}  // namespace spillway::formats
