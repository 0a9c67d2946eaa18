#pragma once
// Point sets and places for the tests of the library: small enough for brute force.

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "src/generators/generators.h"
#include "src/geometry/point.h"
#include "tests/geometry/point_families.h"

namespace spillway::test {

template <int D>
using Points = std::vector<Point<D>>;

/// Points with a name for messages.
template <int D>
struct PointSet {
  std::string name;
  Points<D> points;
};

template <int D>
Points<D> random_points(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  Points<D> points(count);
  for (auto& point : points) {
    for (double& c : point) c = random.uniform(-3, 5);
  }
  return points;
}

/// Integers below `side`, each set of them once, in an order of chance, the first ones repeated.
template <int D>
Points<D> lattice_points(int side, std::uint64_t seed) {
  Points<D> points;
  for (int i = 0, count = D == 2 ? side * side : side * side * side; i < count; ++i) {
    Point<D> point;
    for (int k = 0, rest = i; k < D; ++k, rest /= side) point[k] = rest % side;
    points.push_back(point);
  }
  Random random(seed);
  for (std::size_t i = points.size(); i > 1; --i) {
    std::swap(points[i - 1], points[random.bits() % i]);
  }
  const Points<D> first(points.begin(), points.begin() + side);
  points.insert(points.end(), first.begin(), first.end());
  return points;
}

/// Clusters of points on lines, many of them equal.
template <int D>
Points<D> collinear_clusters(std::uint64_t seed) {
  Random random(seed);
  Points<D> points;
  for (int cluster = 0; cluster < 12; ++cluster) {
    Point<D> start, along;
    for (int k = 0; k < D; ++k) {
      start[k] = static_cast<double>(random.integer(-40, 40));
      along[k] = static_cast<double>(random.integer(-2, 2));
    }
    for (int i = 0; i < 25; ++i) {
      Point<D> point = start;
      const auto step = static_cast<double>(random.integer(0, 12));
      for (int k = 0; k < D; ++k) point[k] += step * along[k];
      points.push_back(point);
    }
  }
  return points;
}

template <int D>
Points<D> of_family(Family family, std::uint64_t count) {
  return generated_points<D>({.family = family, .count = count, .dimension = D, .seed = 3});
}

/// Sets that span D dimensions.
template <int D>
std::vector<PointSet<D>> point_sets() {
  std::vector<PointSet<D>> sets;
  Points<D> simplex(D + 1);
  for (int k = 0; k < D; ++k) simplex[k + 1][k] = 1;
  sets.push_back({"one simplex", simplex});
  sets.push_back({"uniform", random_points<D>(400, 1)});
  sets.push_back({"lattice", lattice_points<D>(D == 2 ? 15 : 6, 2)});
  sets.push_back({"collinear clusters", collinear_clusters<D>(4)});
  sets.push_back({"circle", of_family<D>(Family::kCircle, 200)});
  sets.push_back({"lines", of_family<D>(Family::kLines, 100)});
  sets.push_back({"clusters", of_family<D>(Family::kClusters, 300)});
  sets.push_back({"duplicates", of_family<D>(Family::kDuplicates, 300)});
  sets.push_back({"UTM", of_family<D>(Family::kUtm, 300)});
  Points<D> outlier = random_points<D>(300, 5);
  outlier[7].fill(1e9);
  sets.push_back({"outlier", outlier});
  Points<D> tiny = lattice_points<D>(4, 6);
  for (auto& point : tiny) {
    for (double& c : point) c *= 0x1p-1074;
  }
  sets.push_back({"subnormal", tiny});
  return sets;
}

/// Places in, on and outside of a set's hull, many of them on edges and vertices.
template <int D>
Points<D> places_around(const Points<D>& points, std::size_t count, std::uint64_t seed) {
  Random random(seed);
  const auto any = [&]() -> const Point<D>& { return points[random.bits() % points.size()]; };
  Points<D> places;
  for (std::size_t i = 0; i < count; ++i) {
    const Point<D> a = any(), b = any();
    const double t = random.uniform(-0.3, 1.3);
    Point<D> place = a;
    for (int k = 0; k < D; ++k) {
      if (i % 4 == 1) place[k] = a[k] / 2 + b[k] / 2;
      if (i % 4 == 2) place[k] = a[k] + (b[k] - a[k]) * t;
      if (i % 4 == 3) place[k] = any()[k] + (any()[k] - any()[k]) * random.uniform() * 0.3;
    }
    places.push_back(place);
  }
  return places;
}

using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;

/// "2D" and "3D" in the names of typed tests.
struct DimensionNames {
  template <typename Dimension>
  static std::string GetName(int /*place*/) {
    return std::to_string(Dimension::value) + "D";
  }
};

}  // namespace spillway::test
