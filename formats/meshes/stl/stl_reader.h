#pragma once

#include <optional>
#include <string_view>

#include "formats/bytes/input_bytes.h"
#include "formats/meshes/common/mesh.h"

namespace spillway::formats {

/// Whether a file that begins so is an ASCII STL.
bool looks_like_ascii_stl(std::string_view text);

/// The origin that a file of Spillway's names; nothing if it names none, or an ASCII STL.
std::optional<WorldPoint> stl_origin(InputBytes& source);

/// Reads a binary or ASCII STL file; equal corners become one vertex. The origin that Spillway's
/// header names is added. Normals and attributes are passed over.
Mesh read_stl(InputBytes& source);

}  // namespace spillway::formats
