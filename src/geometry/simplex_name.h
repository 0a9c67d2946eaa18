#pragma once

#include <string>

#include "src/rooms.h"

namespace spillway::geometry {

/// What a simplex of a mesh is called.
constexpr const char* simplex_of(int dimension) {
  return dimension == 2 ? "triangle" : dimension == 3 ? "tetrahedron" : "simplex";
}

/// What the simplices of a mesh are called.
constexpr const char* simplices_of(int dimension) {
  return dimension == 2 ? "triangles" : dimension == 3 ? "tetrahedra" : "simplices";
}

/// The same with the dimension, where it has no name of its own: "simplices of 4 dimensions".
inline std::string simplices_text(int dimension) {
  const std::string name = simplices_of(dimension);
  return dimension > 3 ? name + " of " + std::to_string(dimension) + " dimensions" : name;
}

}  // namespace spillway::geometry
