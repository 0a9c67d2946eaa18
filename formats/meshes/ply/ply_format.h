#pragma once

#include "formats/meshes/common/mesh_format.h"

namespace spillway::formats {

extern const MeshFormat kPlyMesh;       ///< binary when written
extern const MeshFormat kPlyAsciiMesh;  ///< PLY that is written in ASCII

}  // namespace spillway::formats
