#include "src/delaunay/kernel_3d/star_maker.h"

#include <algorithm>

namespace spillway::kernel_3d {

[[gnu::noinline]] bool StarMaker::make_large(const HoleView& hole) {
  bool on_hull = false;
  for (std::size_t i = 0; i < hole.count; ++i) {
    const Handle facet = hole.facets[i];
    const Cell& removed = hole.cells.at(facet);
    const auto& places = kPlaces[CellArray::slot(facet)];
    VertexRef* const vertices = hole.cells.at_first(hole.handles[i]).vertices;
    vertices[0] = hole.apex;
    for (std::size_t k = 1; k < 4; ++k) {
      vertices[k] = removed.vertices[places[k]] & ~kMark;
      on_hull |= vertices[k] == kInfinite;
    }
    hole.cells.join(hole.handles[i], hole.cells.mirror(facet));
  }
  if (hole.count / 2 + 2 < kTableSide) {  // so many vertices it has, by Euler's relation
    join_by_table(hole);
  } else {
    join_by_sorting(hole);
  }
  return on_hull;
}

void StarMaker::join_by_table(const HoleView& hole) {
  if (handle_across_.empty()) handle_across_.resize(kTableSize);
  std::array<VertexRef, kTableSide> known;
  std::size_t known_count = 0;
  // A vertex's number is right if the list has the vertex there.
  const auto number = [&](VertexRef v) -> std::size_t {
    std::uint8_t& n = number_of_[v / 4];
    if (n >= known_count || known[n] != v) {
      n = static_cast<std::uint8_t>(known_count);
      known[known_count++] = v;
    }
    return n;
  };
  for (const bool joining : {false, true}) {
    for (std::size_t i = 0; i < hole.count; ++i) {
      Cell& cell = hole.cells.at_first(hole.handles[i]);
      const std::array<std::size_t, 3> n{number(cell.vertices[1]), number(cell.vertices[2]),
                                         number(cell.vertices[3])};
      for (std::uint32_t k = 0; k < 3; ++k) {
        const std::size_t from = n[(k + 1) % 3];
        const std::size_t to = n[(k + 2) % 3];
        if (joining) {
          cell.neighbours[k + 1] = handle_across_[to * kTableSide + from];
        } else {
          handle_across_[from * kTableSide + to] = hole.handles[i] + k + 1;
        }
      }
    }
  }
}

[[gnu::cold]] void StarMaker::join_by_sorting(const HoleView& hole) {
  struct Edge {
    std::uint64_t ends;  ///< the smaller one first
    Handle corner;
  };
  std::vector<Edge> edges;
  edges.reserve(3 * hole.count);
  for (std::size_t i = 0; i < hole.count; ++i) {
    const VertexRef* const v = hole.cells.at_first(hole.handles[i]).vertices;
    for (std::uint32_t k = 1; k < 4; ++k) {
      const auto [low, high] = std::minmax(v[k % 3 + 1], v[(k + 1) % 3 + 1]);
      edges.push_back({std::uint64_t{low} << 32 | high, hole.handles[i] + k});
    }
  }
  std::sort(edges.begin(), edges.end(),
            [](const Edge& a, const Edge& b) { return a.ends < b.ends; });
  for (std::size_t i = 0; i < edges.size(); i += 2) {
    hole.cells.join(edges[i].corner, edges[i + 1].corner);
  }
}

}  // namespace spillway::kernel_3d
