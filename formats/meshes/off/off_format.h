#pragma once

#include "formats/meshes/common/mesh_format.h"

namespace spillway::detail {

extern const MeshFormat kOffMesh;

}  // namespace spillway::detail
