#pragma once
// Small triangulations in memory, and what a raster of them must be by the plainest means.

#include <cmath>
#include <functional>
#include <vector>

#include "src/delaunay/delaunay.h"
#include "src/geometry/predicates.h"
#include "src/terrain/triangle_pixels.h"
#include "tests/geometry/point_families.h"

namespace spillway::test {

using HeightOf = std::function<double(double x, double y)>;

/// Points in a square from 0 to `side`: whole numbers if `whole`.
inline std::vector<Point<2>> square_points(std::size_t count, double side, bool whole,
                                           std::uint64_t seed) {
  Random random(seed);
  std::vector<Point<2>> points(count);
  for (Point<2>& p : points) {
    for (double& c : p) {
      c = random.uniform(0, side);
      if (whole) c = std::floor(c);
    }
  }
  return points;
}

/// All triangles of the Delaunay triangulation, counter-clockwise.
inline std::vector<Triangle> triangles_of(const std::vector<Point<2>>& points,
                                          const HeightOf& height) {
  const Triangulation<2> mesh = delaunay_triangulation<2>(points, {.threads = 1});
  std::vector<Triangle> triangles;
  for (const auto& list : mesh.lists) {
    for (const auto& simplex : list.simplices) {
      if (simplex.removed() || simplex.infinite()) continue;
      Triangle triangle;
      for (int i = 0; i < 3; ++i) {
        const Point<2>& p = mesh.points[simplex.vertices[i]];
        triangle[i] = {p[0], p[1], height(p[0], p[1])};
      }
      triangles.push_back(triangle);
    }
  }
  return triangles;
}

/// The window of a triangle.
inline PixelWindow box_of(const PixelCentres& centres, const Triangle& triangle) {
  return window_of(centres_around(centres, triangle[0]), centres_around(centres, triangle[1]),
                   centres_around(centres, triangle[2]));
}

/// The number of sides of a counter-clockwise triangle that a point is on, by exact predicates; -1
/// outside.
inline int edges_touched(const Triangle& triangle, const Point<2>& p) {
  int touched = 0;
  for (int i = 0; i < 3; ++i) {
    const Point<3>& a = triangle[i];
    const Point<3>& b = triangle[(i + 1) % 3];
    const int side = orientation<2>({Point<2>{a[0], a[1]}, Point<2>{b[0], b[1]}, p});
    if (side < 0) return -1;
    if (side == 0) ++touched;
  }
  return touched;
}

}  // namespace spillway::test
