#pragma once

#include "formats/meshes/common/mesh_format.h"

namespace spillway::detail {

extern const MeshFormat kObjMesh;

}  // namespace spillway::detail
