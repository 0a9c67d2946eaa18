#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "src/geometry/box.h"
#include "src/geometry/constructions/circumsphere.h"
#include "src/geometry/constructions/half_space.h"
#include "src/geometry/constructions/plate.h"
#include "src/geometry/point.h"

namespace spillway::delaunay {

/// Where a point may destroy or change a simplex: its closed circumsphere (certified), or, of
/// an infinite simplex, the closed half-space beyond its facet.
template <int D>
class ConflictRegion {
 public:
  /// Of a simplex whose corners are positions of `points`, or kInfiniteVertex.
  ConflictRegion(const std::array<VertexId, D + 1>& vertices, std::span<const Point<D>> points);

  /// Of a finite simplex, positively oriented, with this circumsphere.
  ConflictRegion(const std::array<Point<D>, D + 1>& corners, const CertifiedBall<D>& ball)
      : corners_(corners), ball_(ball) {}

  /// Whether it is that of an infinite simplex.
  [[nodiscard]] bool infinite() const { return infinite_; }

  /// Whether the region is the true one, or reaches less than a hundredth of the radius farther.
  [[nodiscard]] bool tight() const {
    constexpr double kLargestError = 0x1p-10;
    return infinite_ ||
           ball_.error * ball_.error < kLargestError * kLargestError * ball_.squared_radius;
  }

  /// False only if the region certainly has no point of the box.
  [[nodiscard]] bool may_meet(const Box<D>& box) const;

  /// The same of a plate.
  [[nodiscard]] bool may_meet(const Plate<D>& plate) const {
    return infinite_ ? spillway::geometry::may_meet<D>(half_space_, plate)
                     : spillway::geometry::may_meet<D>(ball_, plate);
  }

  /// False only if the point certainly lies outside. What needs big integers is not decided.
  [[nodiscard]] bool may_hold(const Point<D>& point) const;

  /// Whether it may meet a leaf of a tree of boxes (Part, or anything with `box` and `children`).
  template <typename Tree>
  [[nodiscard]] bool may_meet_leaf(const Tree& tree) const {
    if (!may_meet(tree.box)) return false;
    if (tree.children.empty()) return true;
    return std::any_of(tree.children.begin(), tree.children.end(),
                       [&](const auto& child) { return may_meet_leaf(child); });
  }

 private:
  bool infinite_ = false;
  std::array<Point<D>, D + 1> corners_{};  ///< of a finite simplex, as is the ball
  CertifiedBall<D> ball_;
  HalfSpace<D> half_space_;  ///< of an infinite one
};

}  // namespace spillway::delaunay
