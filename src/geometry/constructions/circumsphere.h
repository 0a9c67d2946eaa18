#pragma once
// Circumspheres that prove something. A rounded circumcentre proves nothing by itself; here it
// carries a bound on its own error, so that "cannot meet" is a theorem and everything else is
// "may meet": rounding can delay a decision but never falsify one.
// The bounds are derived in docs/algorithm-predicates.md ("Certified balls").

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "src/geometry/box.h"
#include "src/geometry/point.h"
#include "src/geometry/strict_arithmetic.h"

namespace spillway::geometry {

/// The circumsphere of a simplex with a bound on its rounding errors, kept relative to one of the
/// simplex's own vertices so that large offsets cost no accuracy.
template <int D>
requires Dimension<D>
struct CertifiedBall {
  Point<D> anchor;  ///< the simplex's first vertex: the origin of `centre`
  Point<D> centre;  ///< circumcentre minus anchor, rounded
  /// At least the true squared radius; for a well-shaped simplex by a factor of about 1 + 1e-13.
  double squared_radius = std::numeric_limits<double>::infinity();
  /// The true circumcentre is within this distance of `centre` on every axis; infinite (and
  /// squared_radius with it) when the simplex is degenerate, too ill-conditioned, not finite or out
  /// of the range that the proof covers.
  double error = std::numeric_limits<double>::infinity();
};

/// The certified circumsphere of a simplex of any orientation.
template <int D>
CertifiedBall<D> certified_ball(const std::array<Point<D>, D + 1>& simplex);

/// False only if the closed circumsphere certainly has no point in common with the closed box, or
/// if the box is empty. Sides of the box may be infinite.
template <int D>
bool may_meet(const CertifiedBall<D>& ball, const Box<D>& box);

/// The corners of some simplices, coordinate by coordinate, so that several are tested at a time.
template <int D>
struct SimplexBatch {
  static constexpr std::size_t kSize = 64;
  std::array<std::array<std::array<double, kSize>, D>, D + 1> corners;  ///< [corner][axis][simplex]

  /// Sets one simplex; `at(i)` is its i-th corner.
  template <typename At>
  void set(std::size_t simplex, const At& at) {
    for (int i = 0; i <= D; ++i) {
      const Point<D>& corner = at(i);
      for (int k = 0; k < D; ++k) corners[i][k][simplex] = corner[k];
    }
  }
};

/// For each simplex of a batch whether its closed circumsphere is certainly inside the box and
/// touches none of its sides, which may be infinite. With little work, for which it must have a
/// thousandth of its radius between it and the sides, and not be of a very flat simplex.
template <int D>
std::array<bool, SimplexBatch<D>::kSize> well_inside(const SimplexBatch<D>& simplices,
                                                     const Box<D>& box);

/// What certified balls hold, number by number, so that several are tested at a time.
template <int D>
struct BallBatch {
  static constexpr std::size_t kSize = SimplexBatch<D>::kSize;
  using Numbers = std::array<double, kSize>;
  std::array<Numbers, D> anchor;  ///< [axis][ball], as the next one
  std::array<Numbers, D> centre;
  Numbers squared_radius;
  Numbers error;

  /// Whether anything is certified of a ball.
  [[nodiscard]] bool certified(std::size_t ball) const {
    return error[ball] < std::numeric_limits<double>::infinity();
  }
  void set(std::size_t ball, const CertifiedBall<D>& value) {
    for (int k = 0; k < D; ++k) {
      anchor[k][ball] = value.anchor[k];
      centre[k][ball] = value.centre[k];
    }
    squared_radius[ball] = value.squared_radius;
    error[ball] = value.error;
  }
  [[nodiscard]] CertifiedBall<D> at(std::size_t ball) const {
    CertifiedBall<D> result;
    for (int k = 0; k < D; ++k) {
      result.anchor[k] = anchor[k][ball];
      result.centre[k] = centre[k][ball];
    }
    result.squared_radius = squared_radius[ball];
    result.error = error[ball];
    return result;
  }
};

/// The certified circumspheres of the simplices of a batch, of any orientation: as true as those of
/// certified_ball() with less work, but with larger errors where simplices are flat, and infinite
/// ones sooner.
template <int D>
void certify(const SimplexBatch<D>& simplices, BallBatch<D>& balls);

/// may_meet() of those balls whose bits are set in `asked`: a bit for each.
template <int D>
std::uint64_t may_meet(const BallBatch<D>& balls, const Box<D>& box, std::uint64_t asked);

}  // namespace spillway::geometry
