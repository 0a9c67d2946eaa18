#include "stream/sinks/contour_writer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "src/geometry/longest_edge.h"

namespace spillway::stream {

ContourWriter::ContourWriter(ContourSinkOptions options, Sink sink, ScratchFolder& scratch,
                             HullEdges::Sink hull_sink)
    : options_(std::move(options)),
      joiner_(
          [this, sink = std::move(sink)](std::span<const Point<2>> points, std::int64_t level) {
            if (too_short(points)) {
              ++short_lines_;
            } else {
              sink(points, level);
            }
          },
          options_.memory, scratch, options_.tolerance),
      hull_sink_(std::move(hull_sink)) {}

std::vector<WorldPoint> ContourWriter::in_output(std::span<const LatticePoint> vertices) const {
  std::vector<WorldPoint> points;
  points.reserve(vertices.size());
  for (const LatticePoint& vertex : vertices) points.push_back(in_world(options_.lattice, vertex));
  return points;
}

bool ContourWriter::too_short(std::span<const Point<2>> points) const {
  if (!options_.min_length) return false;
  double length = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    length += std::hypot(points[i][0] - points[i - 1][0], points[i][1] - points[i - 1][1]);
  }
  return length < *options_.min_length;
}

bool ContourWriter::too_long(const std::array<Corner, 3>& corners) const {
  if (!options_.max_edge) return false;
  const std::array points = {corners[0].point, corners[1].point, corners[2].point};
  return has_longer_edge<2>(points, *options_.max_edge);
}

void ContourWriter::take_heights(std::span<const WorldPoint> vertices) {
  for (const WorldPoint& vertex : vertices) {
    lowest_ = std::min(lowest_, vertex[2]);
    highest_ = std::max(highest_, vertex[2]);
  }
}

void ContourWriter::draw(const StreamNumbers& numbers, std::span<const WorldPoint> vertices,
                         std::span<const std::uint32_t> corners) {
  const auto corner = [&](std::uint32_t v) { return Corner{numbers[v], vertices[v]}; };
  for (std::size_t c = 0; c < corners.size(); c += 3) {
    const std::array<Corner, 3> triangle = {corner(corners[c]), corner(corners[c + 1]),
                                            corner(corners[c + 2])};
    if (too_long(triangle)) {
      ++left_out_;
      continue;
    }
    if (options_.finds_hull) take_edges(corners.subspan(c, 3));
    segments_.clear();
    append_segments(triangle, options_.levels, options_.tolerance.sum(), segments_);
    for (const IsoSegment& segment : segments_) joiner_.add(segment);
  }
  remove_paired(edges_);
  for (const ShortEdge& edge : edges_) {
    const Corner lesser = corner(edge.lesser);
    const Corner greater = corner(edge.greater);
    hull_.add(edge.from_lesser ? HullEdge{lesser, greater} : HullEdge{greater, lesser});
  }
  edges_.clear();
}

void ContourWriter::take_edges(std::span<const std::uint32_t> triangle) {
  for (std::size_t i = 0; i < 3; ++i) {
    const std::uint32_t from = triangle[i];
    const std::uint32_t to = triangle[(i + 1) % 3];
    edges_.push_back({std::min(from, to), std::max(from, to), from < to});
  }
}

void ContourWriter::write(MeshStreamBlock&& block) {
  std::vector<WorldPoint> vertices = in_output(block.vertices);
  take_heights(vertices);
  live_.append_imported(block, vertices);
  draw({live_.announced(), block}, vertices, block.corners);
  live_.settle(block, vertices);
  // An edge gets no further triangle once one of its ends gets none.
  const auto is_final = [this](const std::array<std::uint64_t, 2>& edge) {
    return !live_.contains(edge[0]) || !live_.contains(edge[1]);
  };
  joiner_.release([&](const Crossing& crossing) { return is_final(crossing.edge); });
  if (hull_sink_) hull_.release(is_final, hull_sink_);
}

void ContourWriter::number_from(std::uint64_t first_vertex) {
  joiner_.number_from(first_vertex);
  hull_.number_from(first_vertex);
}

void ContourWriter::take_merged(const MergedBlock& block) {
  std::vector<WorldPoint> vertices = in_output(block.mesh.vertices);
  take_heights(vertices);
  const std::vector<WorldPoint> imported = in_output(block.imported_vertices);
  vertices.insert(vertices.end(), imported.begin(), imported.end());
  draw({block.first_vertex, block.mesh}, vertices, block.mesh.corners);
}

void ContourWriter::finish(const MeshTotals& /*totals*/) {
  joiner_.finish();
  if (hull_sink_) hull_.finish(hull_sink_);
}

}  // namespace spillway::stream
