#pragma once

#include <string>

#include "formats/meshes/npy/npy_format.h"
#include "formats/meshes/ply/ply_format.h"
#include "formats/meshes/vtu/vtu_format.h"
#include "tests/formats/meshes/mesh_test_helpers.h"

namespace spillway::test {

/// A unit square of two triangles, or a tetrahedron.
inline Mesh small_mesh(int dimension) {
  Mesh mesh;
  mesh.header.dimension = dimension;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0.5}, {0, 1, -2}, {1, 1, 1e-3}};
  mesh.corners = {0, 1, 2, 2, 1, 3};
  if (dimension == 3) mesh.corners = {0, 1, 2, 3};
  mesh.header.vertices = mesh.vertices.size();
  mesh.header.simplices = mesh.corners.size() / mesh.corners_per_simplex();
  return mesh;
}

/// The small mesh with all that a header can say.
inline Mesh full_mesh(int dimension) {
  Mesh mesh = small_mesh(dimension);
  mesh.input_index = {30, 10, 20, 4294967295};
  mesh.header.has_input_index = true;
  mesh.header.lattice = IntegerLattice{{0.5, 0.5, 0.0005}, {500000, 4100000.25, -0.1}};
  mesh.header.crs = "PROJCS[\"a\",\n  UNIT[\"m\",1]]";
  return mesh;
}

/// The one file that a mesh becomes.
inline std::string written(const MeshFormat& format, const Mesh& mesh, std::size_t block = 3) {
  FaultyFileSystem files;
  write_mesh(files, "a.mesh", format, mesh, block);
  EXPECT_EQ(files.files.size(), 1U);
  EXPECT_TRUE(files.parts.empty());
  return files.files.at("a.mesh");
}

/// The formats that hold everything, tetrahedra and input indices included.
inline constexpr const MeshFormat* kFullFormats[] = {&kPlyMesh, &kPlyAsciiMesh, &kVtuMesh,
                                                     &kNpyMesh};

}  // namespace spillway::test
