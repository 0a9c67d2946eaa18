#pragma once

#include "formats/bytes/input_bytes.h"
#include "formats/meshes/common/mesh.h"

namespace spillway::detail {

/// Reads a VTU file of triangles or tetrahedra with appended raw data, UInt64 headers,
/// little-endian, uncompressed, one piece. Throws Error that names the byte.
Mesh read_vtu(InputBytes& source);

}  // namespace spillway::detail
