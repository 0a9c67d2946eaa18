#pragma once

#include "formats/bytes/input_bytes.h"
#include "formats/meshes/common/mesh.h"

namespace spillway::formats {

/// Reads a text OFF file of triangles; colours of faces are passed over. Throws Failure that names
/// the line.
Mesh read_off(InputBytes& source);

}  // namespace spillway::formats
