#include "stream/sinks/contour_writer.h"

#include <algorithm>
#include <array>
#include <utility>

#include "src/geometry/longest_edge.h"

namespace spillway::detail {

ContourWriter::ContourWriter(ContourOptions options, Sink sink, ScratchFolder& scratch)
    : options_(std::move(options)),
      joiner_(
          [this, sink = std::move(sink)](std::span<const Point<2>> points, std::int64_t level) {
            sink(points, options_.levels.height(level));
          },
          options_.memory, scratch) {}

Corner ContourWriter::placed(std::uint64_t number, const Point<3>& vertex) const {
  if (!options_.lattice) return {number, vertex};
  return {number, options_.lattice->to_world(vertex)};
}

/// The block's vertices by their short numbers.
std::vector<Corner> ContourWriter::corners_of(const MeshBlock& block) const {
  std::vector<Corner> corners;
  corners.reserve(block.vertices.size() + block.imported.size());
  for (std::size_t v = 0; v < block.vertices.size(); ++v) {
    corners.push_back(placed(announced_ + v, block.vertices[v]));
  }
  for (const std::uint64_t number : block.imported) {
    corners.push_back({number, live_.at(number)});
  }
  return corners;
}

bool ContourWriter::too_long(const std::array<Corner, 3>& corners) const {
  if (!options_.max_edge) return false;
  const std::array points = {corners[0].point, corners[1].point, corners[2].point};
  return has_longer_edge<2>(points, *options_.max_edge);
}

void ContourWriter::write(MeshBlock&& block) {
  const std::vector<Corner> corners = corners_of(block);
  for (std::size_t c = 0; c < block.corners.size(); c += 3) {
    const std::array<Corner, 3> triangle = {
        corners[block.corners[c]], corners[block.corners[c + 1]], corners[block.corners[c + 2]]};
    if (too_long(triangle)) {
      ++left_out_;
      continue;
    }
    segments_.clear();
    append_segments(triangle, options_.levels, segments_);
    for (const IsoSegment& segment : segments_) joiner_.add(segment);
  }
  for (std::size_t v = 0; v < block.vertices.size(); ++v) {
    lowest_ = std::min(lowest_, corners[v].point[2]);
    highest_ = std::max(highest_, corners[v].point[2]);
  }
  std::vector<bool> finalized(corners.size());
  for (const std::uint32_t v : block.finalized) {
    finalized[v] = true;
    if (v >= block.vertices.size()) live_.erase(corners[v].number);
  }
  for (std::size_t v = 0; v < block.vertices.size(); ++v) {
    if (!finalized[v]) live_.emplace(corners[v].number, corners[v].point);
  }
  announced_ += block.vertices.size();
  // An edge gets no further triangle once one of its ends gets none.
  joiner_.release([this](const Crossing& crossing) {
    return !live_.contains(crossing.edge[0]) || !live_.contains(crossing.edge[1]);
  });
}

void ContourWriter::finish(const MeshTotals& /*totals*/) { joiner_.finish(); }

}  // namespace spillway::detail
