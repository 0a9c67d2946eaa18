#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "src/delaunay/common/triangulation.h"
#include "src/delaunay/divide.h"
#include "src/geometry/constructions/circumsphere.h"

namespace spillway::detail {

/// Where a new point would destroy or change a simplex: its closed circumsphere (certified), or, of
/// an infinite simplex, the closed half-space beyond its facet.
template <int D>
class ConflictRegion {
 public:
  /// Of a simplex whose corners are positions of `points`, or kInfiniteVertex.
  ConflictRegion(const std::array<VertexId, D + 1>& vertices, std::span<const Point<D>> points);

  /// Of a finite simplex with this circumsphere.
  explicit ConflictRegion(const CertifiedBall<D>& ball) : ball_(ball) {}

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

/// Calls visit(s, region) for s = 0, 1, ..., count - 1 with the region of simplex s, whose corners
/// `corners(s)` are positions of `points`, or kInfiniteVertex. Several at a time.
template <int D, typename Corners, typename Visit>
void for_each_region(std::size_t count, const Corners& corners, std::span<const Point<D>> points,
                     const Visit& visit) {
  constexpr std::size_t kSize = SimplexBatch<D>::kSize;
  SimplexBatch<D> batch{};
  std::array<std::array<VertexId, D + 1>, kSize> vertices;
  std::array<CertifiedBall<D>, kSize> balls;
  for (std::size_t begin = 0; begin < count; begin += kSize) {
    const std::size_t end = std::min(count, begin + kSize);
    for (std::size_t s = begin; s < end; ++s) {
      vertices[s - begin] = corners(s);
      const auto& v = vertices[s - begin];
      // An infinite one becomes flat, of which nothing is certified.
      batch.set(s - begin, [&](int i) -> const Point<D>& {
        return points[v[i] == kInfiniteVertex ? v[i == 0 ? 1 : 0] : v[i]];
      });
    }
    certify<D>(batch, balls);
    for (std::size_t s = begin; s < end; ++s) {
      const CertifiedBall<D>& ball = balls[s - begin];
      const bool certified = ball.error < std::numeric_limits<double>::infinity();
      visit(s,
            certified ? ConflictRegion<D>(ball) : ConflictRegion<D>(vertices[s - begin], points));
    }
  }
}

/// What merging needs to remember of each simplex, in parallel with the lists of a triangulation.
enum class Mark : std::uint8_t {
  kInterior,  ///< not in the border, or not yet looked at
  kVague,     ///< a sibling may change it, by a region that is not tight; in the border if
              ///< connected to it by such
  kBorder,    ///< some sibling may change it
  kSurvivor,  ///< in the border, and found again in the triangulation of the border
  kFinal,     ///< no point of another part can change it: it is in no border
};
using ListMarks = SlabArray<Mark>;

/// The border of one part against its siblings: every simplex that a point of `others` may change,
/// found from the infinite simplices `hull` by a search over neighbours (such simplices are
/// connected to the hull, since all of `others` lies beyond it). Marks them kBorder and returns
/// them, in any order.
template <int D>
std::vector<SimplexId> find_border(const Triangulation<D>& triangulation,
                                   std::span<const SimplexId> hull,
                                   std::span<const Part<D>* const> others,
                                   std::span<ListMarks> marks);

/// The same border, but for rounding, of a leaf whose border has no other simplices than
/// `candidates`, numbers in its list; in their order. What is tested lies in the order of memory,
/// and not where a search leads.
template <int D>
std::vector<SimplexId> border_among(const Triangulation<D>& triangulation, std::uint32_t list,
                                    std::span<const std::uint32_t> candidates,
                                    std::span<const Part<D>* const> others,
                                    std::span<ListMarks> marks);

}  // namespace spillway::detail
