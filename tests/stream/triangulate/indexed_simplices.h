#pragma once
// Random points and their triangulation in memory, as sorted input indices: what runs over tiles
// are compared with.

#include <algorithm>
#include <array>
#include <random>
#include <utility>
#include <vector>

#include "src/delaunay/delaunay.h"

namespace spillway::test {

template <int D>
using IndexedSimplices = std::vector<std::array<VertexId, D + 1>>;

/// Points of the unit cube.
template <int D>
std::vector<Point<D>> random_points(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> coordinate(0, 1);
  std::vector<Point<D>> points(count);
  for (Point<D>& point : points) {
    for (double& x : point) x = coordinate(random);
  }
  return points;
}

/// All finite simplices, each sorted, and sorted.
template <int D>
IndexedSimplices<D> triangulated(const std::vector<Point<D>>& points) {
  const Triangulation<D> mesh = delaunay_triangulation<D>(points, {.threads = 1});
  IndexedSimplices<D> simplices;
  mesh.for_each_simplex([&](SimplexId, const Simplex<D>& simplex) {
    if (simplex.infinite()) return;
    auto& indices = simplices.emplace_back();
    for (int k = 0; k <= D; ++k) indices[k] = mesh.input_index[simplex.vertices[k]];
    std::sort(indices.begin(), indices.end());
  });
  std::sort(simplices.begin(), simplices.end());
  return simplices;
}

/// Whether all of `some`, which are sorted, are in `all`.
template <int D>
bool among(const IndexedSimplices<D>& some, const IndexedSimplices<D>& all) {
  return std::includes(all.begin(), all.end(), some.begin(), some.end());
}

}  // namespace spillway::test
