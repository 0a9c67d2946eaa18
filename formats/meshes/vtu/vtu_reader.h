#pragma once

#include <cstdint>

#include "formats/bytes/input_bytes.h"
#include "formats/meshes/common/mesh.h"

namespace spillway::formats {

/// Reads a VTU file of triangles or tetrahedra in one piece. Other arrays of numbers that go with
/// the points become attributes. A compressed block that expands_too_far() by `max_expansion` is an
/// error. Throws Failure that names the byte.
Mesh read_vtu(InputBytes& source, std::uint64_t max_expansion);

}  // namespace spillway::formats
