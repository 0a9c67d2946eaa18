#pragma once
// The spheres of a new star, made for several cells at once and tested with the next point. The
// bounds are derived in docs/algorithm-kernel-3d.md.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "src/delaunay/kernel_3d/cells.h"
#include "src/delaunay/kernel_3d/spheres.h"
#include "src/delaunay/kernel_common/lanes.h"
#include "src/geometry/predicate_stages.h"

namespace spillway::delaunay::kernel_3d {

/// A cell is too flat for its sphere if the product of its edges is this many times its
/// determinant.
inline constexpr double kFlattest = 0x1p40;
/// The tolerance, beside kToleranceOfPlace, in units of the squared radius: for each unit of
/// flatness, ...
inline constexpr double kToleranceOfFlatness = 896 * stages::kRoundoff;
/// ... and for the bits that carry the tolerance.
inline constexpr double kToleranceOfBits = 0x1p-37;
/// On a lattice, where tolerance times determinant is below, s within the tolerance means a tie.
inline constexpr double kCertainTie = 0.4;

/// What the spheres of a star are made of.
struct StarView {
  const double* coordinates;  ///< four for each point: x, y, z, order key
  double largest;             ///< of their magnitudes
  CellArray cells;
  /// The new cells, whose first vertex is the query. After them the last one again, 2 kLanes - 1
  /// times: for lanes that are left over, and for what is gathered ahead.
  const Handle* handles;
  const double* query;  ///< the record of the point just inserted
  const double* next;   ///< that of the next one
};

/// At least the square root of a positive number, and at most 1.07 times it: half its exponent, and
/// between powers of four a straight line.
template <int kLanes>
SPILLWAY_INLINE void root_bound(const Reals<kLanes>& number, Reals<kLanes>& root) {
  constexpr std::uint64_t kHalfOfOne = std::bit_cast<std::uint64_t>(1.0) / 2;
  root = (Reals<kLanes>)(((Bits<kLanes>)number >> 1) + (kHalfOfOne + 1));
}

/// The second, third and fourth vertices of as many cells as there are lanes, relative to the
/// query.
template <int kLanes>
struct Corners {
  Records<kLanes> a, b, c;
};

/// Those of the cells begin, begin + 1, ... of a star.
template <int kLanes>
SPILLWAY_INLINE void gather_corners(const StarView& star, std::size_t begin,
                                    Corners<kLanes>& corners) {
  const auto corner = [&](int slot) {
    Records<kLanes> r = gather<kLanes>([&](int i) {
      return star.coordinates + star.cells.at_cell(star.handles[begin + i]).vertices[slot];
    });
    r.x -= star.query[0];
    r.y -= star.query[1];
    r.z -= star.query[2];
    return r;
  };
  corners = {corner(1), corner(2), corner(3)};
}

/// Makes the spheres of the cells begin, begin + 1, ... of a star, whose corners are given, and
/// tests them with the next point: returns a bit for each that is certainly in conflict with it,
/// and leaves in `certain` only lanes where that, or the opposite, is certain. Half-way, so that
/// there is something to do while quotients take their time, it gathers the corners of the cells
/// from begin + kLanes on.
template <int kLanes, bool kHasOrderKeys>
SPILLWAY_INLINE std::uint32_t make_spheres(const StarView& star, std::size_t begin,
                                           Corners<kLanes>& corners, Integers<kLanes>& certain) {
  using R = Reals<kLanes>;
  using I = Integers<kLanes>;
  const auto [a, b, c] = corners;
  const R aa = a.x * a.x + a.y * a.y + a.z * a.z;
  const R bb = b.x * b.x + b.y * b.y + b.z * b.z;
  const R cc = c.x * c.x + c.y * c.y + c.z * c.z;
  const R bc_x = b.y * c.z - b.z * c.y;
  const R bc_y = b.z * c.x - b.x * c.z;
  const R bc_z = b.x * c.y - b.y * c.x;
  const R ca_x = c.y * a.z - c.z * a.y;
  const R ca_y = c.z * a.x - c.x * a.z;
  const R ca_z = c.x * a.y - c.y * a.x;
  const R ab_x = a.y * b.z - a.z * b.y;
  const R ab_y = a.z * b.x - a.x * b.z;
  const R ab_z = a.x * b.y - a.y * b.x;
  const R determinant = a.x * bc_x + a.y * bc_y + a.z * bc_z;
  const R half = 0.5 / determinant;
  Records<kLanes> sphere;  // the centre relative to the query, at first
  sphere.x = (aa * bc_x + bb * ca_x + cc * ab_x) * half;
  sphere.y = (aa * bc_y + bb * ca_y + cc * ab_y) * half;
  sphere.z = (aa * bc_z + bb * ca_z + cc * ab_z) * half;
  gather_corners<kLanes>(star, begin + kLanes, corners);
  const R squared = sphere.x * sphere.x + sphere.y * sphere.y + sphere.z * sphere.z;
  R edges, radius;
  root_bound<kLanes>(aa * bb * cc, edges);
  root_bound<kLanes>(squared, radius);
  const R tolerance = squared * (edges * half * (2 * kToleranceOfFlatness) + kToleranceOfBits) +
                      radius * (star.largest * kToleranceOfPlace);
  // The next power of two: its exponent.
  I carried = (I)((Bits<kLanes>)tolerance >> kMantissaBits) + 1;
  if constexpr (kHasOrderKeys) {
    carried |= ((R)(carried << kMantissaBits) * determinant < kCertainTie) & kTieNote;
    R largest = R{} + star.query[3];
    const auto compare = [&](const R& order_key, std::int64_t slot) {
      const I larger = order_key > largest;
      largest = larger ? order_key : largest;
      carried = larger ? (carried & (kCarriedMask >> 2)) | slot << kLargestShift : carried;
    };
    compare(a.w, 1);
    compare(b.w, 2);
    compare(c.w, 3);
  }
  sphere.w = (R)(((I)squared & ~kCarriedMask) | carried);
  const I proved = (edges * (1 / kFlattest) < determinant) & (edges >= kSmallestEdges);
  sphere.w = proved ? sphere.w : R{} + std::numeric_limits<double>::quiet_NaN();
  sphere.x += star.query[0];
  sphere.y += star.query[1];
  sphere.z += star.query[2];
  const R x = star.next[0] - sphere.x;
  const R y = star.next[1] - sphere.y;
  const R z = star.next[2] - sphere.z;
  const R s = x * x + y * y + z * z - sphere.w;
  scatter<kLanes>(sphere,
                  [&](int i) { return star.cells.at_cell(star.handles[begin + i]).centre; });
  const I proves = (R)((I)s & kNoSign) > (R)((I)sphere.w << kMantissaBits);
  certain &= proves;
  return mask_of((R)(proves & (I)s));
}

}  // namespace spillway::delaunay::kernel_3d
