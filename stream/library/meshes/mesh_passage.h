#pragma once

#include <cstdint>

#include "formats/meshes/common/mesh_stream.h"
#include "src/geometry/box.h"
#include "stream/library/context/run_watch.h"

namespace spillway::stream {

/// The box around the vertices of a mesh of triangles in x and y, as their blocks give them, and
/// their number.
struct VertexExtent {
  Box<2> box;
  std::uint64_t vertices = 0;
};

/// Reads the whole mesh for it, as phase "extent".
VertexExtent find_vertices(MeshStreamReader& reader, RunWatch& watch);

/// Brings all blocks from a reader to a sink, several of them absorbed at a time. Vertices keep
/// the attributes of `kept`. Returns how many simplices that were.
std::uint64_t pass_mesh(MeshStreamReader& reader, const AttributeLayout& kept, BlockSink& blocks,
                        RunWatch& watch, unsigned threads);

}  // namespace spillway::stream
