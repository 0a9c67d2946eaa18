#include "stream/sinks/contour_writer.h"

#include <algorithm>
#include <array>
#include <utility>

#include "formats/meshes/common/stream_numbers.h"
#include "src/geometry/longest_edge.h"

namespace spillway::detail {

ContourWriter::ContourWriter(ContourOptions options, Sink sink, ScratchFolder& scratch)
    : options_(std::move(options)),
      joiner_(
          [this, sink = std::move(sink)](std::span<const Point<2>> points, std::int64_t level) {
            sink(points, options_.levels.height(level));
          },
          options_.memory, scratch) {}

/// The block's vertices by their short numbers.
std::vector<WorldPoint> ContourWriter::points_of(const MeshBlock& block) const {
  std::vector<WorldPoint> points;
  points.reserve(block.vertices.size() + block.imported.size());
  for (const LatticePoint& vertex : block.vertices) {
    points.push_back(in_world(options_.lattice, vertex));
  }
  live_.append_imported(block, points);
  return points;
}

bool ContourWriter::too_long(const std::array<Corner, 3>& corners) const {
  if (!options_.max_edge) return false;
  const std::array points = {corners[0].point, corners[1].point, corners[2].point};
  return has_longer_edge<2>(points, *options_.max_edge);
}

void ContourWriter::write(MeshBlock&& block) {
  const std::vector<WorldPoint> points = points_of(block);
  const StreamNumbers numbers(live_.announced(), block);
  const auto corner = [&](std::uint32_t v) { return Corner{numbers[v], points[v]}; };
  for (std::size_t c = 0; c < block.corners.size(); c += 3) {
    const std::array<Corner, 3> triangle = {corner(block.corners[c]), corner(block.corners[c + 1]),
                                            corner(block.corners[c + 2])};
    if (too_long(triangle)) {
      ++left_out_;
      continue;
    }
    segments_.clear();
    append_segments(triangle, options_.levels, segments_);
    for (const IsoSegment& segment : segments_) joiner_.add(segment);
  }
  for (std::size_t v = 0; v < block.vertices.size(); ++v) {
    lowest_ = std::min(lowest_, points[v][2]);
    highest_ = std::max(highest_, points[v][2]);
  }
  live_.settle(block, points);
  // An edge gets no further triangle once one of its ends gets none.
  joiner_.release([this](const Crossing& crossing) {
    return !live_.contains(crossing.edge[0]) || !live_.contains(crossing.edge[1]);
  });
}

void ContourWriter::finish(const MeshTotals& /*totals*/) { joiner_.finish(); }

}  // namespace spillway::detail
