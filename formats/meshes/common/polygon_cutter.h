#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "src/geometry/point.h"

namespace spillway::formats {

/// Cuts simple polygons into triangles, one polygon after another in the same memory.
///
/// Of all ways to cut a polygon it takes the constrained Delaunay triangulation in x and y, ties
/// broken as in_sphere() breaks them. There is one only, so the triangles do not depend on where
/// the polygon begins, and cells that are squares become the Delaunay triangulation of their
/// corners. Ears are clipped first (G. Meisters, "Polygons have ears", Amer. Math. Monthly 82
/// (1975)), then edges flipped (C. Lawson, "Transforming triangulations", Discrete Math. 3 (1972)).
class PolygonCutter {
 public:
  using Triangle = std::array<std::uint32_t, 3>;

  /// The triangles of a simple polygon of three corners or more, two fewer than these, which they
  /// number from 0; they go round as the polygon does. Valid until the next call. Takes time in
  /// proportion to the square of the number of corners, at most.
  std::span<const Triangle> cut(std::span<const Point<2>> outline);

 private:
  static constexpr std::uint32_t kNone = 0xffffffff;
  /// The place of the corner in its triangle that was clipped.
  static constexpr std::size_t kClippedSide = 1;

  /// A corner of what is left of the polygon.
  struct RingCorner {
    std::uint32_t before;
    std::uint32_t after;
    std::uint32_t behind;  ///< the triangle at the other side of the edge to `after`, or kNone
    bool is_waiting;       ///< in the queue of what may be an ear
  };
  /// The triangles across the edges opposite the corners, or kNone.
  using Neighbours = std::array<std::uint32_t, 3>;

  void clip_ears();
  [[nodiscard]] bool is_ear(std::uint32_t corner) const;
  void clip(std::uint32_t corner);
  void add_triangle(std::uint32_t corner);
  void join(std::uint32_t corner, std::size_t side);
  void flip_edges();
  bool flip_if_needed(std::uint32_t first, std::size_t side);

  std::vector<Point<2>> points_;  ///< counter-clockwise
  std::vector<RingCorner> ring_;
  std::vector<std::uint32_t> waiting_;  ///< corners, then triangles, to look at
  std::vector<Triangle> triangles_;
  std::vector<Neighbours> neighbours_;
};

}  // namespace spillway::formats
