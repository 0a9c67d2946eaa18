#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "src/geometry/lattice.h"
#include "src/geometry/point.h"

namespace spillway {

/// What a mesh file says about itself.
struct MeshHeader {
  int dimension = 2;               ///< 2: triangles, 3: tetrahedra
  std::uint64_t vertices = 0;      ///< number of vertices
  std::uint64_t simplices = 0;     ///< number of finite simplices
  bool has_input_index = false;    ///< each vertex carries its index in the input
  std::optional<Lattice> lattice;  ///< set if every coordinate is lattice.to_world of an integer
  std::string crs;                 ///< coordinate system as WKT or PROJ text, empty if unknown
};

/// A whole mesh in memory, as `check`, `info` and `convert` read it.
struct Mesh {
  MeshHeader header;
  std::vector<Point<3>> vertices;          ///< output coordinates; z is 0 where the file has none
  std::vector<std::uint64_t> corners;      ///< dimension+1 vertex numbers a simplex, in file order
  std::vector<std::uint64_t> input_index;  ///< one a vertex if header.has_input_index, else empty

  [[nodiscard]] std::size_t corners_per_simplex() const { return header.dimension + 1; }
};

}  // namespace spillway
