#include "stream/sinks/simplex_sink.h"

#include <algorithm>
#include <memory>
#include <span>
#include <utility>

namespace spillway::stream {

std::vector<std::uint32_t> RestOfBlock::divide(MeshStreamBlock& block, std::size_t corners) {
  const auto announced = static_cast<std::uint32_t>(block.vertices.size());
  std::vector<std::uint8_t> is_left(announced, 1);
  for (const std::uint32_t v : block.finalized) {
    if (v < announced) is_left[v] = 0;
  }
  std::vector<std::uint32_t> inner = std::move(block.corners);
  std::vector<std::uint32_t> rest;
  std::size_t kept = 0;
  for (std::size_t s = 0; s < inner.size(); s += corners) {
    const auto simplex = std::span(inner).subspan(s, corners);
    if (std::ranges::all_of(simplex, [&](std::uint32_t v) { return v < announced; })) {
      std::copy(simplex.begin(), simplex.end(), inner.begin() + static_cast<std::ptrdiff_t>(kept));
      kept += corners;
      continue;
    }
    for (const std::uint32_t v : simplex) {
      if (v < announced) is_left[v] = 1;
      rest.push_back(v);
    }
  }
  inner.resize(kept);
  auto absorbed = std::make_shared<RestOfBlock>();
  absorbed->announced_ = announced;
  std::vector<LatticePoint> vertices;
  std::vector<std::byte> attributes;
  const std::size_t record_size = announced > 0 ? block.attributes.size() / announced : 0;
  std::vector<std::uint32_t> number_left(announced);
  for (std::uint32_t v = 0; v < announced; ++v) {
    if (is_left[v] == 0) continue;
    number_left[v] = static_cast<std::uint32_t>(vertices.size());
    vertices.push_back(block.vertices[v]);
    const auto record = std::span(block.attributes).subspan(v * record_size, record_size);
    attributes.insert(attributes.end(), record.begin(), record.end());
    absorbed->places_.push_back(v);
  }
  const auto left = static_cast<std::uint32_t>(vertices.size());
  const auto renumbered = [&](std::uint32_t v) {
    return v < announced ? number_left[v] : v - announced + left;
  };
  for (std::uint32_t& v : rest) v = renumbered(v);
  std::vector<std::uint32_t> finalized;
  for (const std::uint32_t v : block.finalized) {
    if (v >= announced || is_left[v] != 0) finalized.push_back(renumbered(v));
  }
  block.absorbed = std::move(absorbed);
  block.vertices = std::move(vertices);
  block.corners = std::move(rest);
  block.finalized = std::move(finalized);
  block.input_index = {};
  block.attributes = std::move(attributes);
  return inner;
}

}  // namespace spillway::stream
