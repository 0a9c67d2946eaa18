#include "python/vertex_neighbours.h"

#include <fmt/format.h>
#include <spillway/error.h>

#include <algorithm>
#include <cstdint>
#include <limits>

namespace spillway::python {
namespace {

/// Where each point's part of a list begins, if it has `each` places for every cell around it. One
/// more than there are points.
template <class Index>
std::vector<std::size_t> places_for_all(std::span<const Index> cell_vertices, std::size_t each,
                                        std::size_t points) {
  std::vector<std::size_t> begins(points + 1);
  for (const Index v : cell_vertices) begins[static_cast<std::size_t>(v) + 1] += each;
  for (std::size_t p = 0; p < points; ++p) begins[p + 1] += begins[p];
  return begins;
}

}  // namespace

template <class Index>
VertexNeighbours<Index> vertex_neighbours(std::span<const Index> cell_vertices, std::size_t corners,
                                          std::size_t points) {
  const auto begins = places_for_all(cell_vertices, corners - 1, points);
  VertexNeighbours<Index> found;
  found.indices.resize(begins.back());
  auto next = begins;
  for (std::size_t c = 0; c < cell_vertices.size(); c += corners) {
    const auto cell = cell_vertices.subspan(c, corners);
    for (const Index v : cell) {
      for (const Index other : cell) {
        if (other != v) found.indices[next[static_cast<std::size_t>(v)]++] = other;
      }
    }
  }
  // Several cells have an edge in common: what is left of each part moves to the front.
  const auto list = found.indices.begin();
  auto end = list;
  found.starts.reserve(points + 1);
  found.starts.push_back(0);
  for (std::size_t p = 0; p < points; ++p) {
    const auto first = list + static_cast<std::ptrdiff_t>(begins[p]);
    const auto last = list + static_cast<std::ptrdiff_t>(begins[p + 1]);
    std::sort(first, last);
    end = std::copy(first, std::unique(first, last), end);
    found.starts.push_back(static_cast<Index>(end - list));
  }
  const auto count = static_cast<std::size_t>(end - list);
  constexpr auto kMost = static_cast<std::size_t>(std::numeric_limits<Index>::max());
  if (count > kMost) {
    throw Error(ErrorCode::kTooLarge,
                fmt::format("{} neighbours of vertices: at most {} can be numbered", count, kMost));
  }
  found.indices.resize(count);
  return found;
}

template VertexNeighbours<std::int32_t> vertex_neighbours(std::span<const std::int32_t>,
                                                          std::size_t, std::size_t);
template VertexNeighbours<std::int64_t> vertex_neighbours(std::span<const std::int64_t>,
                                                          std::size_t, std::size_t);

}  // namespace spillway::python
