// The families in four to six dimensions; docs/generators.md has their parameters.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "src/error.h"
#include "src/generators/families.h"
#include "src/generators/grid_side.h"
#include "src/generators/integer_circle.h"
#include "src/generators/random.h"
#include "src/geometry/dimensions.h"

namespace spillway::generators {
namespace {

template <int D>
using Sampler = Point<D> (*)(std::uint64_t seed, std::uint64_t i, std::uint64_t size);

/// D independent normal numbers.
template <int D>
Point<D> normal_point(std::uint64_t seed, std::uint64_t i) {
  Random random = Random::of_point(seed, i);
  Point<D> p;
  for (int k = 0; k < D; k += 2) {
    const auto pair = random.normal_pair();
    p[k] = pair[0];
    if (k + 1 < D) p[k + 1] = pair[1];
  }
  return p;
}

/// A uniform point of the unit sphere.
template <int D>
Point<D> direction(std::uint64_t seed, std::uint64_t i) {
  Point<D> p = normal_point<D>(seed, i);
  double square = 0;
  for (const double x : p) square += x * x;
  for (double& x : p) x /= std::sqrt(square);
  return p;
}

template <int D>
Point<D> uniform(std::uint64_t seed, std::uint64_t i, std::uint64_t /*size*/) {
  Random random = Random::of_point(seed, i);
  Point<D> p;
  for (double& x : p) x = random.uniform();
  return p;
}

template <int D>
Point<D> normal(std::uint64_t seed, std::uint64_t i, std::uint64_t /*size*/) {
  Point<D> p = normal_point<D>(seed, i);
  for (double& x : p) x += 0.5;
  return p;
}

template <int D>
Point<D> bubbles(std::uint64_t seed, std::uint64_t i, std::uint64_t /*size*/) {
  Point<D> p = normal_point<D>(seed, i);
  for (int k = 0; k < D; ++k) p[k] = (((i >> k) & 1U) != 0 ? 0.75 : 0.25) + 0.5 * p[k];
  return p;
}

template <int D>
Point<D> ellipsoid(std::uint64_t seed, std::uint64_t i, std::uint64_t /*size*/) {
  Point<D> p = direction<D>(seed, i);
  for (int k = 0; k < D; ++k) p[k] = 0.5 + (0.45 - 0.05 * k) * p[k];
  return p;
}

/// Lines in general position, so many that they span the space: 3 or 4. Points of a round are at
/// the same place of their lines.
template <int D>
Point<D> lines(std::uint64_t seed, std::uint64_t i, std::uint64_t /*size*/) {
  constexpr std::uint64_t kLines = D / 2 + 1;
  const double t = Random::of_point(seed, i / kLines).uniform();
  Random line = Random::of_point(0, i % kLines);
  Point<D> p;
  for (double& x : p) {
    const double begin = line.uniform();
    x = begin + t * (line.uniform() - begin);
  }
  return p;
}

/// `size`: of a side.
template <int D>
Point<D> lattice(std::uint64_t /*seed*/, std::uint64_t i, std::uint64_t size) {
  Point<D> p;
  for (double& x : p) {
    x = static_cast<double>(i % size);
    i /= size;
  }
  return p;
}

/// As on the sphere in space: D - 1 angles with rational cosines and sines, all of an integer
/// circle of radius r, give a point of the integer sphere of radius r^(D - 1), which is below 2^53.
template <int D>
Point<D> circle(std::uint64_t seed, std::uint64_t i, std::uint64_t /*size*/) {
  static const IntegerCircle angles(D == 4 ? 4 : 3);
  double radius = 1;
  for (int k = 1; k < D; ++k) radius *= static_cast<double>(angles.radius());
  Point<D> p;
  if (i % 2 != 0) {
    p = direction<D>(seed, i);
    for (double& x : p) x *= radius;
    return p;
  }
  Random random = Random::of_point(seed, i);
  const Gaussian first = angles.point(random.below(angles.count()));
  p[0] = static_cast<double>(first.re);
  p[1] = static_cast<double>(first.im);
  double of_last = static_cast<double>(angles.radius());
  for (int k = 2; k < D; ++k) {
    const Gaussian angle = angles.half(random.below(angles.half_count()));
    for (int before = 0; before < k; ++before) p[before] *= static_cast<double>(angle.re);
    p[k] = static_cast<double>(angle.im) * of_last;
    of_last *= static_cast<double>(angles.radius());
  }
  return p;
}

template <int D>
Point<D> clusters(std::uint64_t seed, std::uint64_t i, std::uint64_t /*size*/) {
  constexpr std::uint64_t kClusters = 16;
  Random centre = Random::of_point(~seed, i % kClusters);
  Random offset = Random::of_point(seed, i);
  Point<D> p;
  for (double& x : p) x = 1e6 * centre.uniform() + offset.uniform();
  return p;
}

/// `size`: how many sites there are.
template <int D>
Point<D> duplicates(std::uint64_t seed, std::uint64_t i, std::uint64_t size) {
  Random random = Random::of_point(~seed, Random::of_point(seed, i).bits() % size);
  Point<D> p;
  for (double& x : p) x = static_cast<double>(random.below(1 << 20));
  return p;
}

template <int D>
Point<D> collinear(std::uint64_t seed, std::uint64_t i, std::uint64_t /*size*/) {
  constexpr std::array<double, 6> kDirection = {3, -2, 5, -7, 11, -13};
  const auto t = static_cast<double>(Random::of_point(seed, i).below(1 << 28));
  Point<D> p;
  for (int k = 0; k < D; ++k) p[k] = kDirection[k] * t;
  return p;
}

/// In one hyperplane.
template <int D>
Point<D> coplanar(std::uint64_t seed, std::uint64_t i, std::uint64_t /*size*/) {
  Random random = Random::of_point(seed, i);
  Point<D> p;
  p[D - 1] = 7;
  for (int k = 0; k < D - 1; ++k) {
    p[k] = static_cast<double>(random.below(1 << 24));
    p[D - 1] += (k == 0 ? 2 : k == 1 ? -3 : 1) * p[k];
  }
  return p;
}

template <int D>
Point<D> utm(std::uint64_t seed, std::uint64_t i, std::uint64_t /*size*/) {
  Random random = Random::of_point(seed, i);
  Point<D> p;
  for (int k = 0; k < D; ++k) p[k] = (k == 2 ? 200 : 1000) * random.uniform();
  p[0] += 500000;
  p[1] += 4100000;
  return p;
}

/// Null for families of two and three dimensions only.
template <int D>
Sampler<D> sampler_of(Family family) {
  switch (family) {
    case Family::kUniform:
      return uniform<D>;
    case Family::kNormal:
      return normal<D>;
    case Family::kBubbles:
      return bubbles<D>;
    case Family::kEllipsoid:
      return ellipsoid<D>;
    case Family::kLines:
      return lines<D>;
    case Family::kLattice:
      return lattice<D>;
    case Family::kCircle:
      return circle<D>;
    case Family::kClusters:
      return clusters<D>;
    case Family::kDuplicates:
      return duplicates<D>;
    case Family::kCollinear:
      return collinear<D>;
    case Family::kCoplanar:
      return coplanar<D>;
    case Family::kUtm:
      return utm<D>;
    default:
      return nullptr;
  }
}

template <int D>
class HigherGenerator final : public PointGenerator {
 public:
  HigherGenerator(const GeneratorOptions& options, Sampler<D> sampler)
      : options_(options),
        sampler_(sampler),
        size_(grid_side(options.count, options.family == Family::kLattice ? D : 2)) {}

  std::size_t next(std::span<Point<3>> points) override {
    const std::uint64_t n = std::min<std::uint64_t>(points.size(), options_.count - next_);
    further_.clear();
    for (std::uint64_t i = 0; i < n; ++i) {
      const Point<D> p = sampler_(options_.seed, next_++, size_);
      points[i] = {p[0], p[1], p[2]};
      further_.insert(further_.end(), p.begin() + 3, p.end());
    }
    return n;
  }

  [[nodiscard]] std::span<const double> further() const override { return further_; }

 private:
  GeneratorOptions options_;
  Sampler<D> sampler_;
  std::uint64_t size_;
  std::uint64_t next_ = 0;
  std::vector<double> further_;
};

}  // namespace

std::unique_ptr<PointGenerator> make_higher(const GeneratorOptions& options,
                                            std::string_view family) {
  return with_dimension(options.dimension, [&](auto d) -> std::unique_ptr<PointGenerator> {
    if constexpr (d > 3) {
      if (const auto sampler = sampler_of<d>(options.family)) {
        return std::make_unique<HigherGenerator<d>>(options, sampler);
      }
    }
    throw InvalidArgument(
        fmt::format("the family '{}' has 2 or 3 dimensions, not {}", family, options.dimension));
  });
}

}  // namespace spillway::generators
