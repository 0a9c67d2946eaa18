#pragma once

#include "src/rooms.h"

namespace spillway::geometry {

/// What the simplices of a mesh are called.
inline const char* simplices_of(int dimension) {
  return dimension == 2 ? "triangles" : "tetrahedra";
}

}  // namespace spillway::geometry
