#include "formats/meshes/common/mesh_block.h"

#include <algorithm>

#include "formats/meshes/common/stream_numbers.h"

namespace spillway::detail {

void append_stream_numbers(const MeshBlock& block, std::uint64_t first,
                           std::vector<std::uint64_t>& corners) {
  const StreamNumbers numbers(first, block);
  const std::size_t begin = corners.size();
  corners.resize(begin + block.corners.size());
  std::transform(block.corners.begin(), block.corners.end(), corners.begin() + begin,
                 [&numbers](std::uint32_t v) { return numbers[v]; });
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
