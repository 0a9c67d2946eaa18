#include "stream/library/meshes/mesh_passage.h"

#include <cstddef>
#include <utility>
#include <vector>

#include "formats/points/attributes/record_selection.h"
#include "src/parallel/parallel.h"

namespace spillway::stream {
namespace {

struct Slot {
  MeshStreamBlock block;
  std::size_t simplices = 0;
};

}  // namespace

VertexExtent find_vertices(MeshStreamReader& reader, RunWatch& watch) {
  VertexExtent found;
  watch.begin("extent", "vertices");
  for (MeshStreamBlock block; reader.read(block);) {
    for (const LatticePoint& vertex : block.vertices) {
      found.box.expand(Point<2>{vertex[0], vertex[1]});
    }
    watch.tell(found.vertices += block.vertices.size(), reader.fraction_read());
  }
  watch.end(found.vertices);
  return found;
}

std::uint64_t pass_mesh(MeshStreamReader& reader, const AttributeLayout& kept, BlockSink& blocks,
                        RunWatch& watch, unsigned threads) {
  const RecordSelection selection(reader.header().attributes, kept);
  const auto corners = static_cast<std::size_t>(reader.header().dimension) + 1;
  std::uint64_t simplices = 0;
  std::vector<Slot> slots(threads + 1);
  const auto source = [&](std::size_t slot) {
    MeshStreamBlock& block = slots[slot].block;
    block.clear();
    const bool more = reader.read(block);
    slots[slot].simplices = block.corners.size() / corners;
    return more;
  };
  const std::vector<PipelineStep> steps = {
      {.in_order = false,
       .work =
           [&](std::size_t slot) {
             MeshStreamBlock& block = slots[slot].block;
             selection.apply(block.attributes, block.vertices.size());
             blocks.absorb(block);
           }},
      {.in_order = true, .work = [&](std::size_t slot) {
         blocks.write(std::move(slots[slot].block));
         watch.tell(simplices += slots[slot].simplices, reader.fraction_read());
       }}};
  with_threads(threads, [&] { run_pipeline(slots.size(), source, steps); });
  return simplices;
}

}  // namespace spillway::stream
