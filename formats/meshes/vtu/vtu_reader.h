#pragma once

#include "formats/bytes/input_bytes.h"
#include "formats/meshes/common/mesh.h"

namespace spillway::formats {

/// Reads a VTU file of triangles or tetrahedra in one piece. Other arrays of numbers that go with
/// the points become attributes. Throws Failure that names the byte.
Mesh read_vtu(InputBytes& source);

}  // namespace spillway::formats
