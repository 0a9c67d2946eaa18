#pragma once
// Points in the orders in which they come from files.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <ostream>
#include <random>
#include <utility>
#include <vector>

#include "src/geometry/framed_point.h"

namespace spillway::test {

enum class Order {
  kRandom,
  kSorted,
  kFlightLines,
  kStrips,    ///< each overlaps half of the one before, and is flown the other way
  kOutwards,  ///< from the middle
  kCurve,     ///< cell by cell of a quadtree
  kSkewed,    ///< nine tenths in a hundredth of the area
  kCluster,   ///< nine tenths in a millionth of it
  kEqual,     ///< half of them
  kRepeated   ///< half of them at one of a hundred places
};

inline void PrintTo(Order order, std::ostream* out) {
  constexpr std::array kNames = {"Random", "Sorted", "FlightLines", "Strips", "Outwards",
                                 "Curve",  "Skewed", "Cluster",     "Equal",  "Repeated"};
  *out << kNames.at(static_cast<std::size_t>(order));
}

/// Sorts points by a key of each.
template <typename F>
void sort_by(std::vector<LatticePoint>& points, F&& key) {
  std::sort(points.begin(), points.end(),
            [&](const LatticePoint& a, const LatticePoint& b) { return key(a) < key(b); });
}

/// Points in a unit square or, if z is not to be their number, a unit cube.
inline std::vector<LatticePoint> make_points(Order order, std::size_t count, bool numbered = true) {
  std::mt19937_64 random(17);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<LatticePoint> points(count);
  for (LatticePoint& p : points) p = {unit(random), unit(random), unit(random)};
  const auto strip = [](const LatticePoint& p) {  // told by z which of two
    return std::floor(40 * p[0]) - (p[2] < 0.5 ? 1 : 0);
  };
  switch (order) {
    case Order::kRandom:
      break;
    case Order::kSorted:
      std::sort(points.begin(), points.end());
      break;
    case Order::kFlightLines:
      sort_by(points, [](const LatticePoint& p) { return std::pair(std::floor(20 * p[0]), p[1]); });
      break;
    case Order::kStrips:
      sort_by(points, [&](const LatticePoint& p) {
        return std::pair(strip(p), std::fmod(strip(p), 2) == 0 ? p[1] : -p[1]);
      });
      break;
    case Order::kOutwards:
      sort_by(points, [](const LatticePoint& p) { return std::hypot(p[0] - 0.5, p[1] - 0.5); });
      break;
    case Order::kCurve: {
      std::vector<std::pair<std::uint64_t, LatticePoint>> keyed;
      for (const LatticePoint& p : points) {
        std::uint64_t key = 0;
        for (int bit = 1; bit <= 20; ++bit) {
          for (const int k : {1, 0}) {
            key = 2 * key + (static_cast<std::uint64_t>(std::ldexp(p[k], bit)) & 1U);
          }
        }
        keyed.emplace_back(key, p);
      }
      std::ranges::sort(keyed);
      for (std::size_t i = 0; i < count; ++i) points[i] = keyed[i].second;
      break;
    }
    case Order::kSkewed:
    case Order::kCluster:
      for (std::size_t i = 0; i < count; ++i) {
        if (i % 10 == 0) continue;
        for (double& x : points[i]) x = order == Order::kSkewed ? x * 0.1 : 0.3 + x * 1e-3;
      }
      break;
    case Order::kEqual:
      for (std::size_t i = 0; i < count; i += 2) points[i] = {0.25, 0.75, 0.5};
      break;
    case Order::kRepeated:
      for (std::size_t i = 0; i < count; i += 2) {
        for (double& x : points[i]) x = std::floor(10 * x) / 10;
        points[i][2] = 0.5;
      }
      break;
  }
  for (std::size_t i = 0; numbered && i < count; ++i) points[i][2] = static_cast<double>(i);
  return points;
}

}  // namespace spillway::test
