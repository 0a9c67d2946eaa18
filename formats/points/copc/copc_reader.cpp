#include "formats/points/copc/copc_reader.h"

#include <utility>
#include <vector>

#include "formats/points/copc/copc_octree.h"
#include "formats/points/laz/laz_reader.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

/// All nodes, if they have all points. Whoever reads all of a file can do without an octree, so one
/// that is corrupt is no error then. Leaves the source where it was.
std::vector<CopcNode> all_nodes(InputBytes& source, const LasHeader& las) {
  const std::uint64_t position = source.position();
  std::vector<CopcNode> nodes;
  try {
    nodes = select_copc_nodes(source, las, {});
  } catch (const BadInput&) {
    nodes.clear();
  }
  source.seek(position);
  std::uint64_t points = 0;
  for (const CopcNode& node : nodes) points += node.chunk.count;
  if (points != las.count) nodes.clear();
  return nodes;
}

}  // namespace

std::unique_ptr<PointReader> open_copc_reader(std::unique_ptr<InputBytes> source,
                                              const LasHeader& las, const std::string& path,
                                              const PointReaderOptions& options) {
  if (options.resolution > 0 && !source->seekable()) {
    throw BadInput(source->name(),
                   "levels of a COPC file cannot be chosen on a pipe; give the file by its name");
  }
  const bool select = options.bounds || options.resolution > 0;
  if (!source->seekable() || las.count == 0) {
    return open_laz_reader(std::move(source), las, path, options);
  }
  // The points in a box can also be found among all of them, where an octree is lost.
  const bool in_need =
      select && options.salvage && options.resolution <= 0 && all_nodes(*source, las).empty();
  if (in_need) return open_laz_reader(std::move(source), las, path, options);
  const std::vector<CopcNode> nodes =
      select ? select_copc_nodes(*source, las, {options.bounds, options.resolution})
             : all_nodes(*source, las);
  if (!select && nodes.empty()) return open_laz_reader(std::move(source), las, path, options);
  std::vector<LazChunk> chunks;
  std::vector<PointRegion> regions;
  for (const CopcNode& node : nodes) {
    chunks.push_back(node.chunk);
    regions.push_back({node.cube, node.chunk.count});
  }
  return open_laz_reader(std::move(source), las, path, options,
                         LazChoice{std::move(chunks), std::move(regions)});
}

}  // namespace spillway::formats
