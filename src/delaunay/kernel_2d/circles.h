#pragma once
// The first filter of the 2D kernel's predicates: circumcircles with proven tolerances, made for
// several triangles at a time. The bounds are derived in docs/algorithm-kernel-2d.md.

#include <cstddef>
#include <cstdint>

#include "src/delaunay/kernel_2d/filters.h"
#include "src/delaunay/kernel_2d/triangles.h"
#include "src/delaunay/kernel_common/lanes.h"

namespace spillway::delaunay::kernel_2d {

/// Circles are made of triangles whose determinant exceeds the sum of two squared sides by this
/// factor and this summand.
inline constexpr double kFlattest = 0x1p-40;
inline constexpr double kSmallestDeterminant = 0x1p-400;
/// What a circle's tolerance is made of: parts of the squared radius, and of the largest
/// coordinate's square.
inline constexpr double kToleranceOfFlatness = 128 * stages::kRoundoff;
inline constexpr double kToleranceOfSquare = 0x1p-20;
inline constexpr double kToleranceOfPlace = 0x1p-84;

/// The triangles at a point just inserted, counter-clockwise: triangle i has the vertices ring[i]
/// and ring[i + 1]. After their ends lists go on from their beginnings.
struct StarView {
  TriangleArray triangles;
  const Point<2>* scaled;
  const Handle* handles;  ///< the triangles' first ones
  const VertexId* ring;
  Pair apex;       ///< the point
  Pair next;       ///< the one that will be inserted next
  double largest;  ///< magnitude of a coordinate
};

/// What is known of some triangles of a star, as bits, the first one lowest.
struct CircleBits {
  std::uint32_t in_conflict;  ///< certainly, with the next point
  std::uint32_t unproved;     ///< too flat, or infinite
};

/// |query - centre|^2
SPILLWAY_INLINE double squared_distance(const Triangle& triangle, const Pair& query) {
  Pair d;
  load(triangle.centre, d);
  d -= query;
  d *= d;
  return d[0] + d[1];
}

/// Makes the circles of the triangles begin, begin + 1, ... of a star, as many as there are lanes.
template <int kLanes>
SPILLWAY_INLINE CircleBits make_circles(const StarView& star, std::size_t begin) {
  using R = Reals<kLanes>;
  using I = Integers<kLanes>;
  const auto corner = [&](std::size_t i) { return pair_of(star.scaled[star.ring[begin + i]]); };
  R bx, by, cx, cy;
  if constexpr (kLanes == 2) {
    const R first = corner(0) - star.apex;
    const R second = corner(1) - star.apex;
    const R third = corner(2) - star.apex;
    bx = __builtin_shufflevector(first, second, 0, 2);
    by = __builtin_shufflevector(first, second, 1, 3);
    cx = __builtin_shufflevector(second, third, 0, 2);
    cy = __builtin_shufflevector(second, third, 1, 3);
  } else {
    const Pair third = corner(2);
    R apex, even, odd, even_after;
    concatenate(star.apex, star.apex, apex);
    concatenate(corner(0), third, even);
    concatenate(corner(1), corner(3), odd);
    concatenate(third, corner(4), even_after);
    even -= apex;
    odd -= apex;
    even_after -= apex;
    bx = __builtin_shufflevector(even, odd, 0, 4, 2, 6);
    by = __builtin_shufflevector(even, odd, 1, 5, 3, 7);
    cx = __builtin_shufflevector(odd, even_after, 0, 4, 2, 6);
    cy = __builtin_shufflevector(odd, even_after, 1, 5, 3, 7);
  }
  const R bb = bx * bx + by * by;
  const R cc = cx * cx + cy * cy;
  const R sum = bb + cc;
  const R determinant = bx * cy - by * cx;
  const I unproved = ~(sum * kFlattest + kSmallestDeterminant < determinant);
  // Where nothing is proved all bits are set: a NaN, and so is all that comes of it.
  const R half = (R)((I)(0.5 / determinant) | unproved);
  R x = (cy * bb - by * cc) * half;
  R y = (bx * cc - cx * bb) * half;
  const R squared = x * x + y * y;
  const R tolerance = squared * (sum * half * kToleranceOfFlatness + kToleranceOfSquare) +
                      star.largest * star.largest * kToleranceOfPlace;
  const R inner = squared - tolerance;
  const R outer = squared + tolerance;
  x += star.apex[0];
  y += star.apex[1];
  const R dx = x - star.next[0];
  const R dy = y - star.next[1];
  const I in_conflict = dx * dx + dy * dy < inner;
  scatter<kLanes>(Records<kLanes>{x, y, inner, outer},
                  [&](int i) { return star.triangles.at_first(star.handles[begin + i]).centre; });
  return {mask_of((R)in_conflict), mask_of((R)unproved)};
}

}  // namespace spillway::delaunay::kernel_2d
