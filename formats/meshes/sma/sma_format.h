#pragma once

#include "formats/meshes/common/mesh_format.h"

namespace spillway::formats {

extern const MeshFormat kSmaMesh;

}  // namespace spillway::formats
