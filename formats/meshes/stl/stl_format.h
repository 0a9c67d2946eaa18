#pragma once
// Binary STL: see docs/formats-meshes.md ("STL").

#include <cstddef>
#include <string_view>

#include "formats/meshes/common/mesh_format.h"

namespace spillway::formats {

extern const MeshFormat kStlMesh;

inline constexpr std::size_t kStlText = 80;              ///< bytes of text that a file begins with
inline constexpr std::size_t kStlHeader = kStlText + 4;  ///< with the number of triangles
inline constexpr std::size_t kStlTriangle = 4 * 3 * 4 + 2;  ///< normal, corners, attribute

/// What the text of Spillway's files begins with; x, y, z to be added to each corner follow, and a
/// coordinate system if there is room.
inline constexpr std::string_view kStlOrigin = "spillway origin ";

}  // namespace spillway::formats
