#pragma once

#include "formats/bytes/input_bytes.h"
#include "formats/meshes/common/mesh.h"

namespace spillway::formats {

/// Reads the triangles of a binary glTF file's scene: lists of triangles of float32 positions in
/// the file's own buffer, moved by their nodes in double, with z up again. Nothing else may be
/// needed: no compression, no outside buffers. Throws Failure that names the file.
Mesh read_glb(InputBytes& source);

}  // namespace spillway::formats
