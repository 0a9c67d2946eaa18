#include "stream/sinks/dem_writer.h"

#include <span>
#include <utility>

#include "formats/bytes/bytes.h"

namespace spillway::detail {
namespace {

/// Leaves in a block only what write() needs: vertices that come again or that triangles with
/// imported vertices have, and these triangles. `prepared` then holds how many vertices the block
/// announces, then for each that is left its place among them; short numbers are of those left.
void keep_rest(MeshBlock& block) {
  const auto announced = static_cast<std::uint32_t>(block.vertices.size());
  std::vector<std::uint8_t> is_left(announced, 1);
  for (const std::uint32_t v : block.finalized) {
    if (v < announced) is_left[v] = 0;
  }
  std::vector<std::uint32_t> corners;
  for (std::size_t t = 0; t < block.corners.size(); t += 3) {
    const auto triangle = std::span(block.corners).subspan(t, 3);
    if (triangle[0] < announced && triangle[1] < announced && triangle[2] < announced) continue;
    for (const std::uint32_t v : triangle) {
      if (v < announced) is_left[v] = 1;
      corners.push_back(v);
    }
  }
  std::vector<LatticePoint> vertices;
  std::vector<std::uint32_t> number{announced};  // what `prepared` will hold
  std::vector<std::uint32_t> number_left(announced);
  for (std::uint32_t v = 0; v < announced; ++v) {
    if (is_left[v] == 0) continue;
    number_left[v] = static_cast<std::uint32_t>(vertices.size());
    vertices.push_back(block.vertices[v]);
    number.push_back(v);
  }
  const auto left = static_cast<std::uint32_t>(vertices.size());
  const auto renumbered = [&](std::uint32_t v) {
    return v < announced ? number_left[v] : v - announced + left;
  };
  for (std::uint32_t& v : corners) v = renumbered(v);
  std::vector<std::uint32_t> finalized;
  for (const std::uint32_t v : block.finalized) {
    if (v >= announced || is_left[v] != 0) finalized.push_back(renumbered(v));
  }
  const auto bytes = std::as_bytes(std::span(number));
  block.prepared.assign(bytes.begin(), bytes.end());
  block.vertices = std::move(vertices);
  block.corners = std::move(corners);
  block.finalized = std::move(finalized);
  block.input_index = {};
}

}  // namespace

void DemWriter::absorb(MeshBlock& block) {
  const std::vector<PlacedPoint> vertices = dem_.placed(block.vertices);
  dem_.count(vertices);
  dem_.paint(vertices, block.corners);
  keep_rest(block);
}

void DemWriter::write(MeshBlock&& block) {
  if (block.prepared.empty()) absorb(block);
  const auto number = [&block](std::size_t i) {
    return load<std::uint32_t>(block.prepared.data() + i * sizeof(std::uint32_t));
  };
  std::vector<PlacedPoint> vertices = dem_.placed(block.vertices);
  std::vector<std::uint64_t> numbers(vertices.size());
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    numbers[v] = live_.announced() + number(v + 1);
    live_.enter(numbers[v], vertices[v]);
  }
  numbers.insert(numbers.end(), block.imported.begin(), block.imported.end());
  live_.append_imported(block, vertices);
  dem_.paint(vertices, block.corners);
  for (const std::uint32_t v : block.finalized) live_.forget(numbers[v]);
  live_.announce(number(0));
}

void DemWriter::finish(const MeshTotals& /*totals*/) {}

}  // namespace spillway::detail
