#include "formats/meshes/common/triangle_stream_writer.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "formats/meshes/common/mesh_block.h"
#include "src/error.h"

namespace spillway::formats {

TriangleStreamWriter::TriangleStreamWriter(MeshStreamHeader header, std::string name)
    : header_(std::move(header)), name_(std::move(name)) {}

void TriangleStreamWriter::write(MeshStreamBlock&& block) {
  take_positions(block);
  check_short_numbers(block);
  if (block.corners.size() % 3 != 0) fail("a block's corners make no whole number of triangles");
  for (std::size_t i = 0; i < block.corners.size(); i += 3) {
    std::array<WorldPoint, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) corners[k] = positions_[block.corners[i + k]];
    put_triangle(corners);
    ++triangles_;
  }
  live_.settle(block, positions_);
  block.clear();
}

void TriangleStreamWriter::finish(const MeshTotals& totals) {
  if (totals.vertices != live_.announced() || totals.simplices != triangles_) {
    fail(fmt::format("{} vertices and {} triangles were promised, but {} and {} came",
                     totals.vertices, totals.simplices, live_.announced(), triangles_));
  }
  complete();
}

void TriangleStreamWriter::take_positions(const MeshStreamBlock& block) {
  positions_ = world_vertices(header_, block);
  for (const WorldPoint& vertex : positions_) {
    for (const double coordinate : vertex) {
      if (!std::isfinite(coordinate)) {
        fail(fmt::format("a vertex has a coordinate {}; repair the points", coordinate));
      }
    }
  }
  for (const std::uint64_t number : block.imported) {
    const WorldPoint* const position = live_.find(number);
    if (position == nullptr) {
      fail(
          fmt::format("a block imports vertex {}, which has not come yet or is finalized", number));
    }
    positions_.push_back(*position);
  }
}

void TriangleStreamWriter::check_short_numbers(const MeshStreamBlock& block) const {
  for (const auto* const numbers : {&block.corners, &block.finalized}) {
    for (const std::uint32_t number : *numbers) {
      if (number >= positions_.size()) fail(fmt::format("a block has no short number {}", number));
    }
  }
}

void TriangleStreamWriter::fail(const std::string& what, ErrorCode code) const {
  throw CannotWrite(name_, what, code);
}

}  // namespace spillway::formats
