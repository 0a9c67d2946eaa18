#pragma once
// Groups of points that are hard on predicates, for tests: seeded, the same on every machine.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "src/geometry/point.h"

namespace spillway::test {

/// D+2 points: a simplex and a query.
template <int D>
using Group = std::array<Point<D>, D + 2>;

/// A small generator whose numbers do not depend on the standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t bits() {  // splitmix64
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15U);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31);
  }
  /// In [0, 1).
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  double uniform(double lo, double hi) { return lo + (hi - lo) * uniform(); }
  /// In lo..hi, both included.
  std::int64_t integer(std::int64_t lo, std::int64_t hi) {
    return lo + static_cast<std::int64_t>(bits() % static_cast<std::uint64_t>(hi - lo + 1));
  }

 private:
  std::uint64_t state_;
};

enum class Hard {
  kUniform,
  kSmallLattice,
  kLidarLattice,
  kFullRangeLattice,
  kScaledLattice,
  kCospherical,
  kCosphericalNudged,
  kCoplanarNudged,
  kHugeOffset,
  kSubnormal,
  kHuge,
  kLargestDoubles,
  kMixedMagnitudes,
};

inline constexpr std::array kAllHard{
    Hard::kUniform,           Hard::kSmallLattice,   Hard::kLidarLattice,
    Hard::kFullRangeLattice,  Hard::kScaledLattice,  Hard::kCospherical,
    Hard::kCosphericalNudged, Hard::kCoplanarNudged, Hard::kHugeOffset,
    Hard::kSubnormal,         Hard::kHuge,           Hard::kLargestDoubles,
    Hard::kMixedMagnitudes};

inline std::string name_of(Hard family) {
  constexpr std::array kNames{
      "Uniform",     "SmallLattice",      "LidarLattice",   "FullRangeLattice", "ScaledLattice",
      "Cospherical", "CosphericalNudged", "CoplanarNudged", "HugeOffset",       "Subnormal",
      "Huge",        "LargestDoubles",    "MixedMagnitudes"};
  return kNames[static_cast<std::size_t>(family)];
}

/// Moves x by up to `most` units in the last place.
inline double nudge(Random& random, double x, int most) {
  const auto steps = random.integer(-most, most);
  for (std::int64_t i = 0; i < std::abs(steps); ++i) {
    x = std::nextafter(
        x, steps > 0 ? std::numeric_limits<double>::max() : std::numeric_limits<double>::lowest());
  }
  return x;
}

/// An integer point at the distance of (3, 4, 12) or so from the origin.
template <int D>
Point<D> cospherical_point(Random& random) {
  // 65^2 as sums of two squares; 21^2 as sums of three.
  constexpr std::array<std::array<double, 3>, 5> kPlane{
      {{0, 65, 0}, {16, 63, 0}, {25, 60, 0}, {33, 56, 0}, {39, 52, 0}}};
  constexpr std::array<std::array<double, 3>, 5> kSpace{
      {{0, 0, 21}, {4, 5, 20}, {4, 8, 19}, {4, 13, 16}, {8, 11, 16}}};
  Point<D> p{};  // in more dimensions in any three of them
  std::copy_n((D == 2 ? kPlane : kSpace)[random.integer(0, 4)].begin(), std::min(D, 3), p.begin());
  for (int k = D - 1; k > 0; --k) std::swap(p[k], p[random.integer(0, k)]);
  Point<D> result{};
  for (int k = 0; k < D; ++k) result[k] = random.integer(0, 1) == 0 ? p[k] : -p[k];
  return result;
}

template <int D>
Group<D> hard_group(Hard family, Random& random) {
  Group<D> group;
  const auto fill = [&group](auto&& coordinate) {
    for (auto& point : group) {
      for (double& c : point) c = coordinate();
    }
  };
  switch (family) {
    case Hard::kUniform:
      fill([&] { return random.uniform(); });
      break;
    case Hard::kSmallLattice:
      fill([&] { return static_cast<double>(random.integer(-2, 2)); });
      break;
    case Hard::kLidarLattice: {
      const double corner = 848000000;
      fill([&] { return corner + static_cast<double>(random.integer(0, 40)); });
      break;
    }
    case Hard::kFullRangeLattice:
      fill([&] { return static_cast<double>(random.integer(-2147483648LL, 2147483647LL)); });
      break;
    case Hard::kScaledLattice:
      fill([&] { return static_cast<double>(random.integer(0, 30)) * 0.01 + 637000.25; });
      break;
    case Hard::kCospherical:
    case Hard::kCosphericalNudged: {
      const double scale = random.integer(0, 1) == 0 ? 1 : 1000003;
      const double shift = static_cast<double>(random.integer(-1000000, 1000000));
      for (auto& point : group) {
        point = cospherical_point<D>(random);
        for (double& c : point) {
          c = c * scale + shift;
          if (family == Hard::kCosphericalNudged) c = nudge(random, c / 3, 2);
        }
      }
      break;
    }
    case Hard::kCoplanarNudged: {
      Point<D> start;
      std::array<Point<D>, D - 1> span;
      for (double& c : start) c = random.uniform(-10, 10);
      for (auto& vector : span) {
        for (double& c : vector) c = random.uniform(-1, 1);
      }
      for (auto& point : group) {
        point = start;
        for (const auto& vector : span) {
          const double t = random.uniform(-4, 4);
          for (int k = 0; k < D; ++k) point[k] += t * vector[k];
        }
        for (double& c : point) c = nudge(random, c, 1);
      }
      break;
    }
    case Hard::kHugeOffset:
      fill([&] { return 1e15 + static_cast<double>(random.integer(0, 80)) * 0.125; });
      break;
    case Hard::kSubnormal:
      fill([&] { return static_cast<double>(random.integer(-6, 6)) * 0x1p-1074; });
      break;
    case Hard::kHuge:
      fill([&] { return random.uniform(-1e300, 1e300); });
      break;
    case Hard::kLargestDoubles:
      fill([&] {
        return static_cast<double>(random.integer(-1, 1)) * std::numeric_limits<double>::max();
      });
      break;
    case Hard::kMixedMagnitudes:
      fill([&] {
        return std::ldexp(random.uniform(-1, 1), static_cast<int>(random.integer(-400, 400)));
      });
      break;
  }
  return group;
}

template <int D>
std::vector<Group<D>> hard_groups(Hard family, std::size_t count, std::uint64_t seed) {
  Random random(seed * 1000 + static_cast<std::uint64_t>(family));
  std::vector<Group<D>> groups(count);
  for (auto& group : groups) group = hard_group<D>(family, random);
  return groups;
}

/// The first D+1 points of a group.
template <int D>
std::array<Point<D>, D + 1> simplex_of(const Group<D>& group) {
  std::array<Point<D>, D + 1> simplex;
  std::copy_n(group.begin(), D + 1, simplex.begin());
  return simplex;
}

}  // namespace spillway::test
