#include "formats/meshes/common/mesh_block.h"

namespace spillway::detail {

void append_stream_numbers(const MeshBlock& block, std::uint64_t first,
                           std::vector<std::uint64_t>& corners) {
  const std::size_t begin = corners.size();
  corners.resize(begin + block.corners.size());
  const std::size_t vertices = block.vertices.size();
  for (std::size_t i = 0; i < block.corners.size(); ++i) {
    const std::uint32_t number = block.corners[i];
    corners[begin + i] = number < vertices ? first + number : block.imported[number - vertices];
  }
}

MeshHeader header_of_mesh(const MeshStreamHeader& header, const MeshTotals& totals) {
  MeshHeader mesh;
  mesh.dimension = header.dimension;
  mesh.vertices = totals.vertices;
  mesh.simplices = totals.simplices;
  mesh.has_input_index = header.has_input_index;
  mesh.lattice = header.lattice;
  mesh.crs = header.crs;
  return mesh;
}

void move_to_world(const MeshStreamHeader& header, MeshBlock& block) {
  if (!header.lattice) return;
  for (Point<3>& vertex : block.vertices) vertex = header.lattice->to_world(vertex);
}

}  // namespace spillway::detail
