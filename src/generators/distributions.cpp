// The five distributions of Funke and Sanders' evaluation; their parameters are in
// docs/generators.md.

#include <cmath>

#include "src/generators/families.h"
#include "src/generators/random.h"

namespace spillway::generators {
namespace {

struct Uniform {
  std::uint64_t seed;
  int dimension;

  Point<3> operator()(std::uint64_t i) const {
    Random random = Random::of_point(seed, i);
    Point<3> p{};
    for (int k = 0; k < dimension; ++k) p[k] = random.uniform();
    return p;
  }
};

/// Three independent normal numbers, of which the last is 0 in two dimensions.
Point<3> normal_point(Random random, int dimension) {
  const auto [x, y] = random.normal_pair();
  return {x, y, dimension == 3 ? random.normal_pair()[0] : 0.0};
}

struct Normal {
  std::uint64_t seed;
  int dimension;

  Point<3> operator()(std::uint64_t i) const {
    Point<3> p = normal_point(Random::of_point(seed, i), dimension);
    for (int k = 0; k < dimension; ++k) p[k] += 0.5;
    return p;
  }
};

struct Bubbles {
  std::uint64_t seed;
  int dimension;

  Point<3> operator()(std::uint64_t i) const {
    Point<3> p = normal_point(Random::of_point(seed, i), dimension);
    for (int k = 0; k < dimension; ++k) {
      const double centre = ((i >> k) & 1) != 0 ? 0.75 : 0.25;
      p[k] = centre + 0.5 * p[k];
    }
    return p;
  }
};

struct Ellipsoid {
  std::uint64_t seed;
  int dimension;

  Point<3> operator()(std::uint64_t i) const {
    constexpr Point<3> kHalfAxes = {0.45, 0.30, 0.15};
    // A uniform point of the unit circle (von Neumann) or sphere (Marsaglia) without a sine.
    const auto [u, v, s] = Random::of_point(seed, i).in_disc();
    Point<3> p{};
    if (dimension == 2) {
      p = {(u * u - v * v) / s, 2 * u * v / s, 0};
    } else {
      const double factor = 2 * std::sqrt(1 - s);
      p = {u * factor, v * factor, 1 - 2 * s};
    }
    for (int k = 0; k < dimension; ++k) p[k] = 0.5 + kHalfAxes[k] * p[k];
    return p;
  }
};

struct Lines {
  std::uint64_t seed;
  int dimension;

  Point<3> operator()(std::uint64_t i) const {
    // The two points of a pair are at the same place of their lines.
    const double t = Random::of_point(seed, i / 2).uniform();
    Point<3> p = i % 2 == 0 ? Point<3>{t, 0.1 + 0.9 * t, t} : Point<3>{1 - t, t, t};
    if (dimension == 2) p[2] = 0;
    return p;
  }
};

/// Seven of ten points lie in haloes around uniform centres, with as many points at any distance up to
/// the halo's radius (the singular isothermal sphere), and the others evenly. The unit box repeats.
struct Haloes {
  std::uint64_t seed;
  int dimension;

  Point<3> operator()(std::uint64_t i) const {
    constexpr double kHaloes = 256;
    constexpr double kRadius = 0.05;
    Random random = Random::of_point(seed, i);
    Point<3> p{};
    if (random.uniform() >= 0.7) {
      for (int k = 0; k < dimension; ++k) p[k] = random.uniform();
      return p;
    }
    // The first haloes have most points, and are largest.
    const double share = random.uniform();
    const double halo = std::floor(kHaloes * share * share * share);
    Random centre = Random::of_point(mix_bits(seed), static_cast<std::uint64_t>(halo));
    const double distance = kRadius / std::sqrt(1 + halo / 8) * random.uniform();
    const auto [u, v, s] = random.in_disc();
    Point<3> direction{(u * u - v * v) / s, 2 * u * v / s, 0};
    if (dimension == 3) {
      const double factor = 2 * std::sqrt(1 - s);
      direction = {u * factor, v * factor, 1 - 2 * s};
    }
    for (int k = 0; k < dimension; ++k) {
      p[k] = centre.uniform() + distance * direction[k];
      p[k] -= std::floor(p[k]);
      if (p[k] >= 1) p[k] = 0;  // -1e-20, rounded
    }
    return p;
  }
};

}  // namespace

std::unique_ptr<PointGenerator> make_distribution(const GeneratorOptions& options) {
  const std::uint64_t seed = options.seed;
  const int dimension = options.dimension;
  switch (options.family) {
    case Family::kUniform:
      return make_indexed(options, Uniform{seed, dimension});
    case Family::kNormal:
      return make_indexed(options, Normal{seed, dimension});
    case Family::kBubbles:
      return make_indexed(options, Bubbles{seed, dimension});
    case Family::kEllipsoid:
      return make_indexed(options, Ellipsoid{seed, dimension});
    case Family::kLines:
      return make_indexed(options, Lines{seed, dimension});
    case Family::kHaloes:
      return make_indexed(options, Haloes{seed, dimension});
    default:
      return nullptr;
  }
}

}  // namespace spillway::generators
