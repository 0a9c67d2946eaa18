#pragma once

namespace spillway::detail {

/// What the simplices of a mesh are called.
inline const char* simplices_of(int dimension) {
  return dimension == 2 ? "triangles" : "tetrahedra";
}

}  // namespace spillway::detail
