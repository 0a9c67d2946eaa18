#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "src/delaunay/border/conflict_region.h"
#include "src/delaunay/border/point_sketch.h"
#include "src/geometry/constructions/circumsphere.h"
#include "src/geometry/point.h"

namespace spillway::delaunay {

/// The regions of up to 64 simplices, which are held against boxes several at a time. Of each a bit
/// stands in words that ask and answer.
template <int D>
class ConflictRegionBatch {
 public:
  static constexpr std::size_t kSize = SimplexBatch<D>::kSize;
  static_assert(kSize == 64);

  /// Of simplices whose corners `corners(s)`, s = 0, 1, ..., count - 1, are positions of `points`,
  /// or kInfiniteVertex.
  template <typename Corners>
  void set(std::size_t count, const Corners& corners, std::span<const Point<D>> points) {
    std::array<std::array<VertexId, D + 1>, kSize> vertices;
    for (std::size_t s = 0; s < count; ++s) {
      vertices[s] = corners(s);
      const auto& v = vertices[s];
      // An infinite one becomes flat, of which nothing is certified.
      simplices_.set(s, [&](int i) -> const Point<D>& {
        return points[v[i] == kInfiniteVertex ? v[i == 0 ? 1 : 0] : v[i]];
      });
    }
    certify<D>(simplices_, balls_);
    apart_.clear();
    apart_bits_ = 0;
    infinite_ = 0;
    for (std::size_t s = 0; s < count; ++s) {
      if (!balls_.certified(s)) set_apart(s, ConflictRegion<D>(vertices[s], points));
    }
    all_ = count == kSize ? ~std::uint64_t{0} : (std::uint64_t{1} << count) - 1;
  }

  /// The bits of all that were set.
  [[nodiscard]] std::uint64_t all() const { return all_; }
  /// Those of infinite simplices.
  [[nodiscard]] std::uint64_t infinite() const { return infinite_; }

  [[nodiscard]] ConflictRegion<D> region(std::size_t s) const {
    for (const auto& [other, region] : apart_) {
      if (other == s) return region;
    }
    std::array<Point<D>, D + 1> corners;
    for (int i = 0; i <= D; ++i) {
      for (int k = 0; k < D; ++k) corners[i][k] = simplices_.corners[i][k][s];
    }
    return ConflictRegion<D>(corners, balls_.at(s));
  }

  /// ConflictRegion::may_meet() of those `asked` for.
  [[nodiscard]] std::uint64_t may_meet(const Box<D>& box, std::uint64_t asked) const {
    std::uint64_t met = spillway::geometry::may_meet<D>(balls_, box, asked & ~apart_bits_);
    if ((asked & apart_bits_) == 0) return met;
    for (const auto& [s, region] : apart_) {
      if ((asked >> s & 1) != 0 && region.may_meet(box)) met |= std::uint64_t{1} << s;
    }
    return met;
  }

  /// Whether they may meet a leaf of a tree of boxes (Part, or anything with `box` and `children`),
  /// of those `asked` for; where a leaf has a `sketch`, one of its boxes.
  template <typename Tree>
  [[nodiscard]] std::uint64_t may_meet_leaf(const Tree& tree, std::uint64_t asked) const {
    const std::uint64_t near = may_meet(tree.box, asked);
    if (near == 0) return near;
    if (tree.children.empty()) {
      if constexpr (requires { tree.sketch; }) {
        if (tree.sketch) return may_meet_sketch(*tree.sketch, near);
      }
      return near;
    }
    std::uint64_t met = 0;
    for (const auto& child : tree.children) met |= may_meet_leaf(child, near & ~met);
    return met;
  }

  /// Whether they may hold a point of a sketch, of those `asked` for.
  [[nodiscard]] std::uint64_t may_meet_sketch(const PointSketch<D>& sketch,
                                              std::uint64_t asked) const {
    const std::size_t levels = sketch.boxes.levels();
    return levels == 0 ? 0 : may_meet_runs(sketch, levels - 1, 0, asked);
  }

 private:
  [[nodiscard]] std::uint64_t may_meet_runs(const PointSketch<D>& sketch, std::size_t level,
                                            std::size_t begin, std::uint64_t asked) const {
    const std::span<const Box<D>> boxes = sketch.boxes.level(level);
    const std::size_t end = std::min(begin + RunBoxes<D>::kFanOut, boxes.size());
    std::uint64_t met = 0;
    for (std::size_t b = begin; b < end && met != asked; ++b) {
      const std::uint64_t near = may_meet(boxes[b], asked & ~met);
      if (near == 0) continue;
      met |= level == 0 ? may_meet(sketch.plates[b], near)
                        : may_meet_runs(sketch, level - 1, b * RunBoxes<D>::kFanOut, near);
    }
    return met;
  }

  [[nodiscard]] std::uint64_t may_meet(const Plate<D>& plate, std::uint64_t asked) const {
    std::uint64_t met = 0;
    for (; asked != 0; asked &= asked - 1) {
      const int s = std::countr_zero(asked);
      const bool apart = (apart_bits_ >> s & 1) != 0;
      if (apart ? region(s).may_meet(plate)
                : spillway::geometry::may_meet<D>(balls_.at(s), plate)) {
        met |= std::uint64_t{1} << s;
      }
    }
    return met;
  }

  void set_apart(std::size_t s, const ConflictRegion<D>& region) {
    const std::uint64_t bit = std::uint64_t{1} << s;
    apart_.emplace_back(s, region);
    apart_bits_ |= bit;
    if (region.infinite()) infinite_ |= bit;
  }

  SimplexBatch<D> simplices_{};
  BallBatch<D> balls_;
  std::uint64_t all_ = 0;
  std::uint64_t apart_bits_ = 0;
  std::uint64_t infinite_ = 0;
  /// Regions of infinite simplices, and of those of which a batch proves nothing.
  std::vector<std::pair<std::size_t, ConflictRegion<D>>> apart_;
};

/// Calls visit(first, regions) for batches of `count` simplices, of which the first is `first`;
/// `corners(s)` and `points` are as in ConflictRegionBatch::set().
template <int D, typename Corners, typename Visit>
void for_each_region_batch(std::size_t count, const Corners& corners,
                           std::span<const Point<D>> points, const Visit& visit) {
  ConflictRegionBatch<D> regions;
  for (std::size_t first = 0; first < count; first += regions.kSize) {
    regions.set(
        std::min(count - first, regions.kSize), [&](std::size_t s) { return corners(first + s); },
        points);
    visit(first, std::as_const(regions));
  }
}

/// Calls visit(s, region) for s = 0, 1, ..., count - 1 with the region of simplex s, whose corners
/// `corners(s)` are positions of `points`, or kInfiniteVertex. Several at a time.
template <int D, typename Corners, typename Visit>
void for_each_region(std::size_t count, const Corners& corners, std::span<const Point<D>> points,
                     const Visit& visit) {
  for_each_region_batch<D>(count, corners, points,
                           [&](std::size_t first, const ConflictRegionBatch<D>& regions) {
                             const std::size_t end = std::min(count, first + regions.kSize);
                             for (std::size_t s = first; s < end; ++s) {
                               visit(s, regions.region(s - first));
                             }
                           });
}

}  // namespace spillway::delaunay
