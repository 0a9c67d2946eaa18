#include "formats/meshes/common/triangle_stream_writer.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "formats/meshes/common/mesh_block.h"
#include "src/error.h"

namespace spillway::detail {

TriangleStreamWriter::TriangleStreamWriter(MeshStreamHeader header, std::string name)
    : header_(std::move(header)), name_(std::move(name)) {}

void TriangleStreamWriter::write(MeshBlock&& block) {
  move_to_world(header_, block);
  take_positions(block);
  if (block.corners.size() % 3 != 0) fail("a block's corners make no whole number of triangles");
  for (std::size_t i = 0; i < block.corners.size(); i += 3) {
    std::array<Point<3>, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t number = block.corners[i + k];
      if (number >= positions_.size()) fail(fmt::format("a block has no short number {}", number));
      corners[k] = positions_[number];
    }
    put_triangle(corners);
    ++triangles_;
  }
  settle_vertices(block);
  block.clear();
}

void TriangleStreamWriter::finish(const MeshTotals& totals) {
  if (totals.vertices != vertices_ || totals.simplices != triangles_) {
    fail(fmt::format("{} vertices and {} triangles were promised, but {} and {} came",
                     totals.vertices, totals.simplices, vertices_, triangles_));
  }
  complete();
}

void TriangleStreamWriter::take_positions(const MeshBlock& block) {
  for (const Point<3>& vertex : block.vertices) {
    for (const double coordinate : vertex) {
      if (!std::isfinite(coordinate)) {
        fail(fmt::format("a vertex has a coordinate {}; repair the points", coordinate));
      }
    }
  }
  positions_ = block.vertices;
  for (const std::uint64_t number : block.imported) {
    const auto found = live_.find(number);
    if (found == live_.end()) {
      fail(fmt::format("a block imports vertex {}, which has not come or comes no more", number));
    }
    positions_.push_back(found->second);
  }
}

/// Forgets the vertices that come no more and keeps the new ones that may.
void TriangleStreamWriter::settle_vertices(const MeshBlock& block) {
  const std::size_t fresh = block.vertices.size();
  finalized_.assign(positions_.size(), false);
  for (const std::uint32_t number : block.finalized) {
    if (number >= positions_.size()) fail(fmt::format("a block has no short number {}", number));
    finalized_[number] = true;
    if (number >= fresh) live_.erase(block.imported[number - fresh]);
  }
  for (std::size_t i = 0; i < fresh; ++i) {
    if (!finalized_[i]) live_.emplace(vertices_ + i, block.vertices[i]);
  }
  vertices_ += fresh;
}

void TriangleStreamWriter::fail(const std::string& what) const {
  throw Error(fmt::format("cannot write {}: {}", name_, what));
}

}  // namespace spillway::detail
