#pragma once
// The first filter of the 3D kernel's predicates: what cells keep of their circumspheres and of the
// bound of their error, and tests with them. Derived in docs/algorithm-kernel-3d.md.

#include <bit>
#include <cstdint>
#include <limits>

#include "src/delaunay/kernel_3d/cells.h"
#include "src/delaunay/kernel_common/lanes.h"
#include "src/geometry/predicate_stages.h"

namespace spillway::delaunay::kernel_3d {

/// Below, products of edges may have lost too much by underflow.
inline constexpr double kSmallestEdges = 0x1p-400;
/// The tolerance, in units of the radius times the largest coordinate.
inline constexpr double kToleranceOfPlace = 16 * stages::kRoundoff;
/// Radius of the ball that stands for a half-space, over the extent of all points.
inline constexpr double kBallOfHalfSpace = 0x1p24;
/// The tolerance of s there, over the squared extent.
inline constexpr double kHalfSpaceTolerance = 4;

/// The last bits of a squared radius: the exponent of the tolerance, and notes on lattice cells.
inline constexpr std::int64_t kTieNote = 0x1000;  ///< s within the tolerance is a tie
inline constexpr int kLargestShift = 13;          ///< the slot of the largest vertex, two bits
inline constexpr std::int64_t kCarriedMask = 0x7FFF;
inline constexpr int kMantissaBits = 52;

/// All bits of a number but its sign.
inline constexpr std::int64_t kNoSign = std::numeric_limits<std::int64_t>::max();

SPILLWAY_INLINE double tolerance_of(double squared_radius) {
  return std::bit_cast<double>(std::bit_cast<std::uint64_t>(squared_radius) << kMantissaBits);
}

/// The notes on a lattice cell: whether s within the tolerance is a tie, and the slot of the
/// largest vertex.
SPILLWAY_INLINE bool notes_tie(double squared_radius) {
  return (std::bit_cast<std::int64_t>(squared_radius) & kTieNote) != 0;
}
SPILLWAY_INLINE std::uint32_t largest_slot(double squared_radius) {
  return std::bit_cast<std::uint64_t>(squared_radius) >> kLargestShift & 3;
}

/// Of four cells a bit each: which are in conflict, and for which that is not certain.
struct FourAnswers {
  std::uint32_t inside;
  std::uint32_t doubtful;
};

/// Tests the query with four cells, at(0) to at(3).
template <int kLanes, typename At>
SPILLWAY_INLINE FourAnswers test_four(const At& at, const double* query) {
  using R = Reals<kLanes>;
  using I = Integers<kLanes>;
  // Bits for as many neighbours as there are lanes, from their squared distances' summands.
  const auto answer = [](const R& x, const R& y, const R& z,
                         const R& squared_radius) -> FourAnswers {
    const R s = x + y + z - squared_radius;
    const R tolerance = (R)((I)squared_radius << kMantissaBits);
    const I certain = (R)((I)s & kNoSign) > tolerance;
    return {mask_of(s), mask_of((R)~certain)};
  };
  if constexpr (kLanes == 2) {
    R q_low, q_high;
    load(query, q_low);
    load(query + 2, q_high);
    const auto two = [&](int k) {
      R low[2], high[2], place[2];
      for (int i = 0; i < 2; ++i) {
        const Cell& other = at(k + i);
        load(other.centre, low[i]);
        load(other.centre + 2, place[i]);
        low[i] = q_low - low[i];
        low[i] = low[i] * low[i];
        high[i] = q_high - place[i];
        high[i] = high[i] * high[i];
      }
      return answer(__builtin_shufflevector(low[0], low[1], 0, 2),
                    __builtin_shufflevector(low[0], low[1], 1, 3),
                    __builtin_shufflevector(high[0], high[1], 0, 2),
                    __builtin_shufflevector(place[0], place[1], 1, 3));
    };
    const FourAnswers low = two(0);
    const FourAnswers high = two(2);
    return {low.inside | high.inside << 2, low.doubtful | high.doubtful << 2};
  } else {
    R q;
    load(query, q);
    const auto test = [&](int k, R& result) {
      const Cell& other = at(k);
      R sphere;
      load(other.centre, sphere);
      result = q - sphere;
      result = result * result;
      result = __builtin_shufflevector(result, sphere, 0, 1, 2, 7);
    };
    R x, y, z, w;
    test(0, x);
    test(1, y);
    test(2, z);
    test(3, w);
    transpose(x, y, z, w);
    return answer(x, y, z, w);
  }
}

}  // namespace spillway::delaunay::kernel_3d
