#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "src/delaunay/kernel_common/simplex_listing.h"
#include "src/delaunay/kernel_nd/simplices.h"
#include "src/delaunay/kernel_nd/working_points.h"

namespace spillway::delaunay::kernel_nd {

/// Whether the circumsphere of a finite simplex certainly lies inside the box and touches no side.
/// docs/algorithm-kernel-nd.md, "Spheres inside a box".
template <int D>
bool is_inside(const SimplexRecord<D>& simplex, const WorkingPoints<D>& points, const Box<D>& box) {
  const double* const corner = points.row(simplex.vertices[0]);
  double squared_radius = 0;
  double squared_error = 0;  // of the centre
  double room = std::numeric_limits<double>::infinity();
  for (int k = 0; k < D; ++k) {
    const double centre = -simplex.power.gradient[k] / 2;
    const double to_corner = corner[k] - centre;
    const double error = simplex.power.tolerance / (2 * points.extents[k]);
    squared_radius += to_corner * to_corner;
    squared_error += error * error;
    room = std::min({room, centre - box.lo[k] - error, box.hi[k] - centre - error});
  }
  constexpr double kRoundings = 1 + 0x1p-40;
  return room > kRoundings * (std::sqrt(squared_radius) + std::sqrt(squared_error));
}

/// kernel::list_range of this kernel's records.
template <int D, typename Number, typename Made>
void list_range(const SimplexArray<D>& records, const WorkingPoints<D>& points, std::uint32_t begin,
                std::uint32_t end, const Number& number, Made* made,
                kernel::ListingNotes<D>& notes) {
  constexpr bool kCornersOnly = !std::is_same_v<Made, Simplex<D>>;
  static_assert(sizeof(SimplexRecord<D>) >= 2 * sizeof(Simplex<D>), "they are listed over records");
  for (std::uint32_t i = begin; i < end; ++i) {
    const SimplexRecord<D>& record = records.record(i);
    Simplex<D> simplex;
    bool finite = true;
    for (int slot = 0; slot <= D; ++slot) {
      VertexId v = record.vertices[slot];
      simplex.neighbours[slot] = SimplexArray<D>::number(record.neighbours[slot]);
      if (v == kernel::kInfinite) {
        finite = false;
        v = kInfiniteVertex;
      } else {
        number(v);
      }
      simplex.vertices[slot] = v;
    }
    const bool inside = points.safe_box && finite && is_inside(record, points, *points.safe_box);
    if constexpr (kCornersOnly) {
      made[i] = simplex.vertices;
    } else {
      made[i] = simplex;
    }
    if (!finite) notes.hull.push_back(i);
    if (!points.safe_box || inside) continue;
    notes.not_inside.push_back(i);
    if (kCornersOnly && notes.lists_open) notes.open_simplices.push_back(simplex);
  }
}

}  // namespace spillway::delaunay::kernel_nd
