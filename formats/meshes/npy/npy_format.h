#pragma once

#include "formats/meshes/common/mesh_format.h"

namespace spillway::formats {

/// A mesh as arrays side by side.
extern const MeshFormat kNpyMesh;

}  // namespace spillway::formats
