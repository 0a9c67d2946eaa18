#pragma once

#include "formats/bytes/input_bytes.h"
#include "formats/meshes/common/mesh.h"

namespace spillway::formats {

/// Reads the vertices and triangles of a Wavefront OBJ file; normals, texture, groups, materials,
/// points and lines are passed over. Throws Failure that names the line.
Mesh read_obj(InputBytes& source);

}  // namespace spillway::formats
