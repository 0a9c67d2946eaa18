#pragma once

#include <string_view>

#include "formats/bytes/input_bytes.h"
#include "formats/meshes/common/mesh.h"

namespace spillway::detail {

/// Whether a file that begins so is an ASCII STL.
bool looks_like_ascii_stl(std::string_view text);

/// Reads a binary or ASCII STL file; equal corners become one vertex. The origin that Spillway's
/// header names is added. Normals and attributes are passed over.
Mesh read_stl(InputBytes& source);

}  // namespace spillway::detail
