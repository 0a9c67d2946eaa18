#pragma once
// Decisions on what the cached spheres leave in doubt, the tie rule of tiny lattices among them,
// for any number of lanes: as in insertion_by_lanes.h.

#include <algorithm>
#include <bit>
#include <cstdint>

#include "src/delaunay/kernel_3d/exact_predicates.h"
#include "src/delaunay/kernel_3d/insertion.h"
#include "src/delaunay/kernel_3d/spheres.h"

namespace spillway::delaunay::kernel_3d {

/// The determinant of the differences of three points to a query, by their records. On tiny
/// lattices it is exact.
SPILLWAY_INLINE double volume(const double* query, const double* a, const double* b,
                              const double* c) {
  Reals<4> q, u, v, w;
  load(query, q);
  load(a, u);
  load(b, v);
  load(c, w);
  u -= q;
  v -= q;
  w -= q;
  // x, y and z of the vector product stand where y, z and x of the first difference come to.
  const Reals<4> product =
      v * __builtin_shufflevector(w, w, 1, 2, 0, 3) - w * __builtin_shufflevector(v, v, 1, 2, 0, 3);
  const Reals<4> terms = product * __builtin_shufflevector(u, u, 2, 0, 1, 3);
  return terms[0] + terms[1] + terms[2];
}

/// On a lattice, for a query that is on a cell's sphere: the tie rule. The largest vertex, which
/// mostly decides, has been noted.
template <bool kHasOrderKeys>
template <int kLanes>
SPILLWAY_INLINE bool Insertion<kHasOrderKeys>::noted_tie_conflicts(const Cell& cell,
                                                                   VertexRef query) const {
  if (!points_.tiny) return tie_conflicts(points_, {vertices_of(cell), query});
  const double* q = points_.at(query);
  std::uint32_t largest = largest_slot(cell.squared_radius);
  for (;;) {
    Words v;
    load_from_slot<kLanes>(cell, largest, v);
    v &= ~kMark;
    const double coefficient = volume(q, points_.at(v[1]), points_.at(v[2]), points_.at(v[3]));
    const double order_key = points_.at(v[0])[3];
    // What the coefficient says holds only if the vertex is larger than the query. That is hard to
    // foresee, so it is no condition.
    const double decisive = std::min(order_key - q[3], coefficient);
    if (decisive != 0) return decisive > 0;
    double next = q[3];
    for (std::uint32_t slot = 0; slot < 4; ++slot) {
      const double other = points_.at(cell.vertices[slot] & ~kMark)[3];
      if (other < order_key && other > next) {
        next = other;
        largest = slot;
      }
    }
    if (next == q[3]) return false;
  }
}

/// Of the doubtful neighbours of a cell, those in conflict.
template <bool kHasOrderKeys>
template <int kLanes>
[[gnu::noinline]] std::uint32_t Insertion<kHasOrderKeys>::decide(const Cell& cell,
                                                                 std::uint32_t doubtful,
                                                                 VertexRef query) const {
  std::uint32_t result = 0;
  for (; doubtful != 0; doubtful &= doubtful - 1) {
    const int k = std::countr_zero(doubtful);
    const Handle there = CellArray::cell_of(cell.neighbours[k]);
    const Cell& other = cells_.at_cell(there);
    const bool inside =
        tie_is_noted(other) ? noted_tie_conflicts<kLanes>(other, query) : conflicts(there, query);
    result |= static_cast<std::uint32_t>(inside) << k;
  }
  return result;
}

}  // namespace spillway::delaunay::kernel_3d
