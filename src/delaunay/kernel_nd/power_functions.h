#pragma once
// How the kernel makes the power functions of new simplices, several at a time, with the bounds of
// their errors. Derived in docs/algorithm-kernel-nd.md.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "src/delaunay/kernel_common/lanes.h"
#include "src/delaunay/kernel_nd/simplices.h"
#include "src/delaunay/kernel_nd/working_points.h"
#include "src/geometry/determinants.h"
#include "src/geometry/predicate_stages.h"

namespace spillway::delaunay::kernel_nd {

using kernel::Reals;

/// Where the points of a simplex differ less on an axis, underflow may have lost too much.
inline constexpr double kShortestEdge = 0x1p-100;
/// For the roundings of the bounds themselves, and of the tolerance to a float.
inline constexpr double kSlack = 1.03;
/// A facet that is narrower on an axis than this part of what it is on another one, both measured
/// by the extents of all points, is taken to be as wide.
inline constexpr double kNarrow = 0x1p-10;

inline constexpr float kProvesNothing = std::numeric_limits<float>::infinity();

/// As a float; one that is not a number proves nothing either.
SPILLWAY_INLINE float as_tolerance(double tolerance) {
  return tolerance < std::numeric_limits<float>::max() ? static_cast<float>(tolerance)
                                                       : kProvesNothing;
}

/// Makes a value at least the magnitude of another; lanes are no results of functions, which not
/// all processors could pass on.
template <typename R>
SPILLWAY_INLINE void raise_to_magnitude(R& most, const R& value) {
  const R negative = -value;
  const R size = value < negative ? negative : value;
  most = most < size ? size : most;
}

/// The coordinates of the simplices' corners in a slot, by axis.
template <int kLanes, int D>
SPILLWAY_INLINE void load_corners(const WorkingPoints<D>& points,
                                  const std::array<SimplexRecord<D>*, kLanes>& simplices, int slot,
                                  Reals<kLanes>* coordinates) {
  using R = Reals<kLanes>;
  std::array<const double*, kLanes> rows;
  for (int lane = 0; lane < kLanes; ++lane)
    rows[lane] = points.row(simplices[lane]->vertices[slot]);
  if constexpr (kLanes == 2) {
    for (int k = 0; k < D; ++k) coordinates[k] = R{rows[0][k], rows[1][k]};
  } else {
    for (int lane = 0; lane < 4; ++lane) kernel::load(rows[lane], coordinates[lane]);
    kernel::transpose(coordinates[0], coordinates[1], coordinates[2], coordinates[3]);
    for (int k = 4; k < D; ++k) coordinates[k] = R{rows[0][k], rows[1][k], rows[2][k], rows[3][k]};
  }
}

/// The functions of as many finite simplices as there are lanes; an infinite one among them gets
/// something without a meaning.
template <int kLanes, int D>
SPILLWAY_INLINE void make_sphere_powers(const WorkingPoints<D>& points,
                                        const std::array<SimplexRecord<D>*, kLanes>& simplices) {
  using R = Reals<kLanes>;
  std::array<R, D> anchor;
  std::array<std::array<R, D + 1>, D> rows;
  load_corners<kLanes, D>(points, simplices, 0, anchor.data());
  std::array<R, D> widths{};
  for (int i = 0; i < D; ++i) {
    load_corners<kLanes, D>(points, simplices, i + 1, rows[i].data());
    for (int k = 0; k < D; ++k) {
      rows[i][k] -= anchor[k];
      raise_to_magnitude(widths[k], rows[i][k]);
    }
    R squares = rows[i][0] * rows[i][0];
    for (int k = 1; k < D; ++k) squares += rows[i][k] * rows[i][k];
    rows[i][D] = squares;
  }
  const auto determinants = minors(rows);
  constexpr unsigned kAxes = (1U << D) - 1;
  const R& determinant = determinants[kAxes];
  const R inverse = 0.5 / determinant;
  R constant{};
  R farthest{};  // the products of extents and magnitudes of the centre, from the anchor, summed up
  double squared_extents = 0;
  std::array<R, D> gradient;
  for (int k = 0; k < D; ++k) {
    const R& numerator = determinants[(kAxes ^ 1U << k) | 1U << D];
    const R centre = (D - 1 - k) % 2 == 0 ? numerator * inverse : -(numerator * inverse);
    R size{};
    raise_to_magnitude(size, centre);
    farthest += points.extents[k] * size;
    squared_extents += points.extents[k] * points.extents[k];
    const R twice = 2 * (anchor[k] + centre);
    gradient[k] = -twice;
    constant += anchor[k] * (twice - anchor[k]);
  }
  R volume = widths[0];
  R squared_widths = widths[0] * widths[0];
  R narrowest = widths[0];
  R least_share = widths[0] * points.inverse_extents[0];
  for (int k = 1; k < D; ++k) {
    volume *= widths[k];
    squared_widths += widths[k] * widths[k];
    const R share = widths[k] * points.inverse_extents[k];
    narrowest = widths[k] < narrowest ? widths[k] : narrowest;
    least_share = share < least_share ? share : least_share;
  }
  constexpr double kRoundings = stages::kOrientationRoundings<D>;
  constexpr double kMonomials = stages::kRoundoff * static_cast<double>(stages::factorial(D));
  const R extent_share = 1 / least_share;
  const R error = kMonomials * volume * (kRoundings + 4 * D * extent_share);
  const R numerator_error =
      kMonomials * volume * squared_widths * (kRoundings + D + 2 + (4 * D + 4) * extent_share);
  R size{};
  raise_to_magnitude(size, determinant);
  const R tolerance =
      kSlack * ((4 * D * extent_share * numerator_error + 8 * farthest * error) / size +
                (8 * (D + 6) + 21) * stages::kRoundoff * (squared_extents + farthest));
  for (int lane = 0; lane < kLanes; ++lane) {
    PowerFunction<D>& power = simplices[lane]->power;
    for (int k = 0; k < D; ++k) power.gradient[k] = gradient[k][lane];
    power.constant = constant[lane];
    power.curvature = 1;
    const bool proved = size[lane] > 2 * error[lane] && narrowest[lane] >= kShortestEdge;
    power.tolerance = proved ? as_tolerance(tolerance[lane]) : kProvesNothing;
  }
}

/// The function of an infinite simplex.
template <int D>
void make_half_space_power(const WorkingPoints<D>& points, SimplexRecord<D>& simplex) {
  const int infinite = simplex.infinite_slot();
  std::array<const double*, D> facet;
  for (int slot = 0, n = 0; slot <= D; ++slot) {
    if (slot != infinite) facet[n++] = points.row(simplex.vertices[slot]);
  }
  std::array<std::array<double, D>, D - 1> edges;
  std::array<double, D> widths{};
  for (int i = 0; i < D - 1; ++i) {
    for (int k = 0; k < D; ++k) {
      edges[i][k] = facet[i + 1][k] - facet[0][k];
      raise_to_magnitude(widths[k], edges[i][k]);
    }
  }
  double largest_share = 0;
  for (int k = 0; k < D; ++k) {
    largest_share = std::max(largest_share, widths[k] / points.extents[k]);
  }
  double volume = 1;
  double extent_share = 0;
  double narrowest = std::numeric_limits<double>::infinity();
  for (int k = 0; k < D; ++k) {
    const double width = std::max(widths[k], kNarrow * largest_share * points.extents[k]);
    volume *= width;
    extent_share = std::max(extent_share, points.extents[k] / width);
    narrowest = std::min(narrowest, width);
  }
  const auto cofactors = minors(edges);
  // The orientation with a point in the infinite vertex's slot is positive if that lies beyond.
  const double inwards = ((D - infinite) % 2 == 0 ? -1 : 1) / volume;
  PowerFunction<D>& power = simplex.power;
  power.constant = 0;
  power.curvature = 0;
  for (int k = 0; k < D; ++k) {
    const double cofactor = cofactors[((1U << D) - 1) ^ 1U << k];
    power.gradient[k] = ((D - 1 + k) % 2 == 0 ? cofactor : -cofactor) * inwards;
    power.constant -= power.gradient[k] * facet[0][k];
  }
  constexpr auto kMonomials = static_cast<double>(stages::factorial(D - 1));
  const double roundings =
      stages::kOrientationRoundings<D - 1> + 4 * (D - 1) * extent_share + 2 * (D + 7);
  const double tolerance =
      kSlack * 2 * D * extent_share * kMonomials * stages::kRoundoff * roundings;
  power.tolerance = narrowest >= kShortestEdge ? as_tolerance(tolerance) : kProvesNothing;
}

/// The functions of new simplices, by their numbers; `some_infinite` says whether there may be
/// infinite ones.
template <int kLanes, int D>
SPILLWAY_INLINE void make_powers(const WorkingPoints<D>& points, const SimplexArray<D>& array,
                                 std::span<const std::uint32_t> numbers, bool some_infinite) {
  for (std::size_t i = 0; i < numbers.size(); i += kLanes) {
    std::array<SimplexRecord<D>*, kLanes> simplices;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      simplices[lane] = &array.record(numbers[std::min(i + lane, numbers.size() - 1)]);
    }
    make_sphere_powers<kLanes, D>(points, simplices);
    if (!some_infinite) continue;
    for (SimplexRecord<D>* const simplex : simplices) {
      if (simplex->infinite()) make_half_space_power(points, *simplex);
    }
  }
}

}  // namespace spillway::delaunay::kernel_nd
