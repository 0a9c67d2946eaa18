#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "src/delaunay/divide.h"
#include "src/delaunay/triangulation.h"
#include "src/geometry/circumsphere.h"

namespace spillway {

/// Where a new point would destroy or change a simplex: its closed circumsphere (certified), or, of
/// an infinite simplex, the closed half-space beyond its facet.
template <int D>
class ConflictRegion {
 public:
  /// Of a simplex whose corners are positions of `points`, or kInfiniteVertex.
  ConflictRegion(const std::array<VertexId, D + 1>& vertices, std::span<const Point<D>> points);

  /// Whether it is that of an infinite simplex.
  [[nodiscard]] bool infinite() const { return infinite_; }

  /// False only if the region certainly has no point of the box.
  [[nodiscard]] bool may_meet(const Box<D>& box) const;

  /// True only if the region certainly lies inside the box. The box may be infinite.
  [[nodiscard]] bool inside(const Box<D>& box) const;

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
  CertifiedBall<D> ball_;          ///< of a finite simplex
  std::array<Point<D>, D> facet_;  ///< of an infinite one
};

/// False only if no point inside any of the boxes of `others` can destroy or change the simplex.
/// Walks each part's tree of boxes down to the leaves.
template <int D>
bool may_be_changed(const Simplex<D>& simplex, std::span<const Point<D>> points,
                    std::span<const Part<D>* const> others);

/// What merging needs to remember of each simplex, in parallel with the blocks of a triangulation.
enum class Mark : std::uint8_t {
  kInterior,  ///< not in the border, or not yet looked at
  kBorder,    ///< some sibling may change it
  kSurvivor,  ///< in the border, and found again in the triangulation of the border
};
using BlockMarks = std::vector<Mark>;

/// The border of one part against its siblings: every simplex that a point of `others` may change,
/// found from the infinite simplices `hull` by a search over neighbours (such simplices are
/// connected to the hull, since all of `others` lies beyond it). Marks them kBorder and returns
/// them sorted.
template <int D>
std::vector<SimplexId> find_border(const Triangulation<D>& triangulation,
                                   std::span<const SimplexId> hull,
                                   std::span<const Part<D>* const> others,
                                   std::span<BlockMarks> marks);

}  // namespace spillway
