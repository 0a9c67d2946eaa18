#pragma once

#include "formats/bytes/input_source.h"
#include "formats/meshes/common/mesh.h"

namespace spillway::detail {

/// Reads a text OFF file of triangles; colours of faces are passed over. Throws Error that names
/// the line.
Mesh read_off(InputSource& source);

}  // namespace spillway::detail
