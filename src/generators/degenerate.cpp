// Families where general position fails: grids, cocircular points, repeated points, flat sets, and
// sets that strain the coordinates. Described in docs/generators.md.

#include <array>
#include <cmath>

#include "src/generators/families.h"
#include "src/generators/grid_side.h"
#include "src/generators/integer_circle.h"
#include "src/generators/random.h"

namespace spillway::generators {
namespace {

/// Row by row through a square or cube of `side` points an axis.
struct Grid {
  std::uint64_t side;
  int dimension;

  Point<3> operator()(std::uint64_t i) const {
    const std::uint64_t row = i / side;
    const std::uint64_t layer = row / side;
    const double x = static_cast<double>(i % side);
    if (dimension == 2) return {x, static_cast<double>(row), 0};
    return {x, static_cast<double>(row % side), static_cast<double>(layer)};
  }
};

/// Has no factor in common with the numbers of points of integer circles, 2^a 3^b: multiplication
/// by it permutes them and scatters neighbours.
constexpr std::uint64_t kScatter = 1000003;

/// Even points: exactly on the circle, as long as there are new ones. All others: rounded to
/// doubles.
struct Circle {
  std::uint64_t seed;
  IntegerCircle circle;

  Circle(std::uint64_t the_seed, std::uint64_t count)
      : seed(the_seed), circle(enough_primes(count / 2 + 1)) {}

  static int enough_primes(std::uint64_t points) {
    int primes = 1;
    while (primes < IntegerCircle::kMostPrimes && IntegerCircle(primes).count() < points) ++primes;
    return primes;
  }

  Point<3> operator()(std::uint64_t i) const {
    if (i % 2 == 0 && i / 2 < circle.count()) {
      const Gaussian p = circle.point((i / 2 * kScatter + seed % circle.count()) % circle.count());
      return {static_cast<double>(p.re), static_cast<double>(p.im), 0};
    }
    const auto [u, v, s] = Random::of_point(seed, i).in_disc();
    const auto radius = static_cast<double>(circle.radius());
    return {radius * ((u * u - v * v) / s), radius * (2 * u * v / s), 0};
  }
};

/// The same on a sphere. Two angles with rational cosines and sines, both of an integer circle of
/// radius r, give a point of the integer sphere of radius r^2.
struct Sphere {
  std::uint64_t seed;
  IntegerCircle circle{5};

  Point<3> operator()(std::uint64_t i) const {
    const std::uint64_t count = circle.half_count() * circle.count();
    const auto radius = static_cast<double>(circle.radius());
    if (i % 2 == 0 && i / 2 < count) {
      const std::uint64_t index = (i / 2 * kScatter + seed % count) % count;
      const Gaussian latitude = circle.half(index / circle.count());
      const Gaussian longitude = circle.point(index % circle.count());
      return {static_cast<double>(latitude.re * longitude.re),
              static_cast<double>(latitude.re * longitude.im),
              static_cast<double>(latitude.im * circle.radius())};
    }
    const auto [u, v, s] = Random::of_point(seed, i).in_disc();
    const double factor = radius * radius * (2 * std::sqrt(1 - s));
    return {u * factor, v * factor, radius * radius * (1 - 2 * s)};
  }
};

/// Sixteen clusters a millionth of their distance wide.
struct Clusters {
  std::uint64_t seed;
  int dimension;

  Point<3> operator()(std::uint64_t i) const {
    constexpr std::uint64_t kClusters = 16;
    Random centre = Random::of_point(~seed, i % kClusters);
    Random offset = Random::of_point(seed, i);
    Point<3> p{};
    for (int k = 0; k < dimension; ++k) p[k] = 1e6 * centre.uniform() + offset.uniform();
    return p;
  }
};

/// About sqrt(n) integer points, each many times.
struct Duplicates {
  std::uint64_t seed;
  int dimension;
  std::uint64_t sites;

  Point<3> operator()(std::uint64_t i) const {
    const std::uint64_t site = Random::of_point(seed, i).bits() % sites;
    Random random = Random::of_point(~seed, site);
    Point<3> p{};
    for (int k = 0; k < dimension; ++k) p[k] = static_cast<double>(random.below(1 << 20));
    return p;
  }
};

struct Collinear {
  std::uint64_t seed;
  int dimension;

  Point<3> operator()(std::uint64_t i) const {
    const auto t = static_cast<double>(Random::of_point(seed, i).below(1 << 28));
    return {3 * t, -2 * t, dimension == 3 ? 5 * t : 0};
  }
};

struct Coplanar {
  std::uint64_t seed;
  int dimension;

  Point<3> operator()(std::uint64_t i) const {
    Random random = Random::of_point(seed, i);
    const auto x = static_cast<double>(random.below(1 << 24));
    const auto y = static_cast<double>(random.below(1 << 24));
    return {x, y, dimension == 3 ? 2 * x - 3 * y + 7 : 0};
  }
};

/// A square kilometre far from the origin, as doubles that were never quantised.
struct Utm {
  std::uint64_t seed;
  int dimension;

  Point<3> operator()(std::uint64_t i) const {
    Random random = Random::of_point(seed, i);
    Point<3> p = {500000 + 1000 * random.uniform(), 4100000 + 1000 * random.uniform(), 0};
    if (dimension == 3) p[2] = 200 * random.uniform();
    return p;
  }
};

}  // namespace

std::unique_ptr<PointGenerator> make_degenerate(const GeneratorOptions& options) {
  const auto [family, count, dimension, seed] = options;
  switch (family) {
    case Family::kLattice:
      return make_indexed(options, Grid{grid_side(count, dimension), dimension}, IntegerLattice{});
    case Family::kCircle:
      if (dimension == 2) return make_indexed(options, Circle(seed, count));
      return make_indexed(options, Sphere{seed});
    case Family::kClusters:
      return make_indexed(options, Clusters{seed, dimension});
    case Family::kDuplicates:
      return make_indexed(options, Duplicates{seed, dimension, grid_side(count, 2)},
                          IntegerLattice{});
    case Family::kCollinear:
      return make_indexed(options, Collinear{seed, dimension}, IntegerLattice{});
    case Family::kCoplanar:
      return make_indexed(options, Coplanar{seed, dimension}, IntegerLattice{});
    case Family::kUtm:
      return make_indexed(options, Utm{seed, dimension});
    default:
      return nullptr;
  }
}

}  // namespace spillway::generators
