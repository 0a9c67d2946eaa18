#include "src/delaunay/kernel_3d/star_maker.h"

#include <algorithm>
#include <bit>

namespace spillway::delaunay::kernel_3d {

[[gnu::noinline]] bool StarMaker::make_large(const HoleView& hole) {
  vertices_.resize(std::max(vertices_.size(), hole.count));
  bool on_hull = false;
  for (std::size_t i = 0; i < hole.count; ++i) {
    const Handle facet = hole.facets[i];
    const Cell& removed = hole.cells.at(facet);
    const auto& places = kPlaces[CellArray::slot(facet)];
    vertices_[i] = Words{hole.apex, removed.vertices[places[1]], removed.vertices[places[2]],
                         removed.vertices[places[3]]} &
                   ~kMark;
    for (std::size_t k = 1; k < 4; ++k) on_hull |= vertices_[i][k] == kInfinite;
  }
  for (std::size_t i = 0; i < hole.count; ++i) {
    store(vertices_[i], hole.cells.at_cell(hole.handles[i]).vertices);
    hole.cells.join(CellArray::facet(hole.handles[i], 0), hole.outer[i]);
  }
  if (hole.count / 2 + 2 < kTableSide) {  // the number of its vertices, by Euler's relation
    join_by_table(hole);
  } else {
    join_by_hashing(hole);
  }
  return on_hull;
}

/// Here vertices are numbered in the order of their appearance.
void StarMaker::join_by_table(const HoleView& hole) {
  corner_handle_across_.resize(kTableSide * kTableSide);
  around_.resize(std::max(around_.size(), hole.count));
  std::array<VertexRef, kTableSide> known;
  std::uint32_t known_count = 0;
  // A vertex's number is right if the list has the vertex there.
  const auto number = [&](VertexRef v) -> std::uint32_t {
    std::uint8_t& n = number_of_[v / 4];
    if (n >= known_count || known[n] != v) {
      n = static_cast<std::uint8_t>(known_count);
      known[known_count++] = v;
    }
    return n;
  };
  for (std::size_t i = 0; i < hole.count; ++i) {
    around_[i] = around(number(vertices_[i][1]), number(vertices_[i][2]), number(vertices_[i][3]));
    const Edges edges = along(around_[i]);
    corner_handle_across_[edges.first] = CellArray::facet(hole.handles[i], 1);
    corner_handle_across_[edges.second] = CellArray::facet(hole.handles[i], 2);
    corner_handle_across_[edges.third] = CellArray::facet(hole.handles[i], 3);
  }
  for (std::size_t i = 0; i < hole.count; ++i) {
    const Edges edges = back_along(around_[i]);
    Handle* const neighbours = hole.cells.at_cell(hole.handles[i]).neighbours;
    neighbours[1] = corner_handle_across_[edges.first];
    neighbours[2] = corner_handle_across_[edges.second];
    neighbours[3] = corner_handle_across_[edges.third];
  }
}

void StarMaker::join_by_hashing(const HoleView& hole) {
  const std::size_t size = std::bit_ceil(3 * hole.count);  // twice the number of edges, or more
  const int shift = 64 - std::countr_zero(size);
  hashed_edges_.assign(size, {});
  for (std::size_t i = 0; i < hole.count; ++i) {
    const Words& v = vertices_[i];
    for (std::uint32_t k = 1; k < 4; ++k) {
      const Handle corner = CellArray::facet(hole.handles[i], k);
      const std::uint32_t a = v[k % 3 + 1];
      const std::uint32_t b = v[(k + 1) % 3 + 1];
      const std::uint64_t ends = std::uint64_t{std::max(a, b)} << 32 | std::min(a, b);
      std::size_t place = ends * 0x9E3779B97F4A7C15 >> shift;
      while (hashed_edges_[place].ends != 0 && hashed_edges_[place].ends != ends) {
        place = (place + 1) % size;
      }
      Edge& edge = hashed_edges_[place];
      if (edge.ends == ends) {
        hole.cells.join(corner, edge.corner);
      } else {
        edge = {ends, corner};
      }
    }
  }
}

}  // namespace spillway::delaunay::kernel_3d
