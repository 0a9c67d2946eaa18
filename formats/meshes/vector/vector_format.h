#pragma once

#include "formats/meshes/common/mesh_format.h"

namespace spillway::formats {

// Tables that GDAL reads and writes.
extern const MeshFormat kGpkgMesh;
extern const MeshFormat kShpMesh;

}  // namespace spillway::formats
