#include "formats/meshes/common/mesh_block.h"

#include <algorithm>

#include "formats/meshes/common/stream_numbers.h"

namespace spillway::formats {

void append_stream_numbers(const MeshStreamBlock& block, std::uint64_t first,
                           std::vector<std::uint64_t>& corners) {
  const StreamNumbers numbers(first, block);
  const std::size_t begin = corners.size();
  corners.resize(begin + block.corners.size());
  std::transform(block.corners.begin(), block.corners.end(), corners.begin() + begin,
                 [&numbers](std::uint32_t v) { return numbers[v]; });
}

MeshFileHeader header_of_mesh(const MeshStreamHeader& header, const MeshTotals& totals) {
  MeshFileHeader mesh;
  mesh.dimension = header.dimension;
  mesh.vertices = totals.vertices;
  mesh.simplices = totals.simplices;
  mesh.has_input_index = header.has_input_index;
  mesh.lattice = header.lattice;
  mesh.crs = header.crs;
  mesh.attributes = header.attributes;
  mesh.periodic = header.periodic;
  return mesh;
}

std::optional<std::vector<LatticePoint>> vertices_on_lattice(const Mesh& mesh,
                                                             const IntegerLattice& lattice,
                                                             int axes) {
  std::vector<LatticePoint> vertices = vertices_without_lattice(mesh);
  for (LatticePoint& vertex : vertices) {
    for (int k = 0; k < axes; ++k) {
      const auto integer = lattice.to_integer(k, vertex[k]);
      if (!integer) return std::nullopt;
      vertex[k] = *integer;
    }
  }
  return vertices;
}

std::vector<LatticePoint> vertices_without_lattice(const Mesh& mesh) {
  std::vector<LatticePoint> vertices;
  vertices.reserve(mesh.vertices.size());
  for (const WorldPoint& vertex : mesh.vertices) vertices.emplace_back(vertex.numbers());
  return vertices;
}

std::vector<WorldPoint> world_vertices(const MeshStreamHeader& header,
                                       const MeshStreamBlock& block) {
  std::vector<WorldPoint> vertices;
  vertices.reserve(block.vertices.size());
  for (const LatticePoint& vertex : block.vertices) {
    vertices.push_back(in_world(header.lattice, vertex));
  }
  return vertices;
}

}  // namespace spillway::formats
