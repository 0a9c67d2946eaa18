#pragma once

#include "formats/meshes/common/mesh_format.h"

namespace spillway::detail {

extern const MeshFormat kLandXmlMesh;

}  // namespace spillway::detail
