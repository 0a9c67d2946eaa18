#pragma once

#include "formats/meshes/common/mesh.h"

namespace spillway::test {

/// Two triangles with heights, on no lattice.
inline Mesh square_mesh() {
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0.5}, {0, 1, -2}, {1, 1, 3}};
  mesh.corners = {0, 1, 2, 2, 1, 3};
  mesh.header.vertices = 4;
  mesh.header.simplices = 2;
  return mesh;
}

}  // namespace spillway::test
