#include "stream/library/public_values.h"

#include <fmt/format.h>

#include <limits>
#include <unordered_map>
#include <utility>

#include "formats/meshes/common/mesh_block.h"
#include "src/error.h"

namespace spillway::detail {
namespace {

/// The short numbers of a block's vertices: its own come first, then those that it imports.
class ShortNumbers {
 public:
  explicit ShortNumbers(const spillway::MeshBlock& block)
      : first_(block.first_vertex), own_(block.vertices.size()) {}

  std::uint32_t of(std::uint64_t vertex) {
    if (vertex >= first_ + own_) {
      throw InvalidArgument(fmt::format("a block of a mesh uses vertex {}, but only {} have come",
                                        vertex, first_ + own_));
    }
    if (vertex >= first_) return static_cast<std::uint32_t>(vertex - first_);
    const auto [place, is_new] =
        short_.try_emplace(vertex, static_cast<std::uint32_t>(own_ + imported_.size()));
    if (is_new) imported_.push_back(vertex);
    return place->second;
  }

  std::vector<std::uint64_t> take_imported() { return std::move(imported_); }

 private:
  std::uint64_t first_;
  std::size_t own_;
  std::vector<std::uint64_t> imported_;
  std::unordered_map<std::uint64_t, std::uint32_t> short_;
};

}  // namespace

spillway::MeshHeader public_header(const MeshStreamHeader& header) {
  spillway::MeshHeader told;
  told.dimension = header.dimension;
  told.has_input_index = header.has_input_index;
  told.points = header.points;
  if (header.extent && !header.extent->empty()) {
    told.extent = Extent{header.extent->lo, header.extent->hi};
  }
  told.crs = header.crs;
  return told;
}

MeshStreamHeader stream_header(const spillway::MeshHeader& header) {
  MeshStreamHeader stream;
  stream.dimension = header.dimension;
  stream.has_input_index = header.has_input_index;
  stream.points = header.points;
  if (header.extent) stream.extent = Box<3>{header.extent->low, header.extent->high};
  stream.crs = header.crs;
  return stream;
}

spillway::MeshTotals public_totals(const MeshTotals& totals) {
  return {totals.vertices, totals.simplices,  totals.hull_facets,
          totals.points,   totals.duplicates, totals.canonical_hash};
}

MeshTotals stream_totals(const spillway::MeshTotals& totals) {
  return {totals.vertices, totals.simplices,  totals.hull_facets,
          totals.points,   totals.duplicates, totals.canonical_hash};
}

spillway::MeshBlock public_block(const MeshStreamHeader& header, MeshBlock&& block,
                                 std::uint64_t first_vertex) {
  spillway::MeshBlock told;
  told.first_vertex = first_vertex;
  append_stream_numbers(block, first_vertex, told.corners);
  told.finalized.reserve(block.finalized.size());
  const std::size_t own = block.vertices.size();
  for (const std::uint32_t vertex : block.finalized) {
    told.finalized.push_back(vertex < own ? first_vertex + vertex : block.imported[vertex - own]);
  }
  move_to_world(header, block);
  told.vertices = std::move(block.vertices);
  told.input_index = std::move(block.input_index);
  return told;
}

MeshBlock stream_block(const spillway::MeshBlock& block) {
  if (block.vertices.size() + block.corners.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw InvalidArgument("a block of a mesh has too many vertices and corners: give smaller ones");
  }
  ShortNumbers numbers(block);
  MeshBlock stream;
  stream.vertices = block.vertices;
  stream.input_index = block.input_index;
  stream.corners.reserve(block.corners.size());
  for (const std::uint64_t vertex : block.corners) stream.corners.push_back(numbers.of(vertex));
  stream.finalized.reserve(block.finalized.size());
  for (const std::uint64_t vertex : block.finalized) {
    stream.finalized.push_back(numbers.of(vertex));
  }
  stream.imported = numbers.take_imported();
  return stream;
}

Report public_report(const StreamFigures& figures, const PointCounts& counts) {
  Report report;
  report.mesh = public_totals(figures.totals);
  report.points = {counts.read,    counts.withheld, counts.every,  counts.classes,
                   counts.returns, counts.bounds,   counts.thinned};
  report.left_out = figures.left_out;
  report.threads = figures.threads;
  report.tiles = figures.tiles;
  report.leaves = figures.leaves;
  report.spilled_points = figures.spilled_points;
  report.spilled_bytes = figures.spilled_bytes;
  report.border_bytes = figures.border_bytes;
  report.read_seconds = figures.read_seconds;
  report.triangulate_seconds = figures.divide_seconds + figures.triangulate_seconds;
  return report;
}

}  // namespace spillway::detail
