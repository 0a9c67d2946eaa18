// Centres of spheres of two sizes, packed densely, as atoms of a metallic glass are. Described in
// docs/generators.md.

#include <algorithm>
#include <array>
#include <cstdint>

#include "src/generators/families.h"
#include "src/generators/grid_side.h"
#include "src/generators/random.h"
#include "src/generators/shuffle.h"

namespace spillway::generators {
namespace {

// Of Cu64Zr36, in angstrom.
constexpr double kSmallRadius = 1.28;
constexpr double kLargeRadius = 1.60;
constexpr double kLargeShare = 0.36;
constexpr double kSpacing = 2.85;  ///< of neighbouring sites: the spheres fill 72 % of space

// How far centres leave their sites follows from how much the radii differ.
constexpr double kMismatch = kLargeRadius - kSmallRadius;
constexpr double kPush = 0.25 * kMismatch;     ///< by each large neighbour, away from it
constexpr double kTremble = 0.45 * kMismatch;  ///< at most, in any direction

/// Where in the densest lattice a sphere sits, in steps along the axes.
using Site = std::array<std::int64_t, 3>;

/// Cubic close packing: the sites whose coordinates have an even sum, row by row through a
/// cube. The pushes of the twelve neighbours add up to sqrt(10) kPush at most, so two centres stay
/// 2.05 apart.
struct SpaceSites {
  static constexpr int kDimension = 3;
  static constexpr double kHalfDiagonal = kSpacing * 0x1.6a09e667f3bcdp-1;
  static constexpr Point<3> kStep = {kHalfDiagonal, kHalfDiagonal, kHalfDiagonal};
  static constexpr std::array<Site, 12> kNeighbours = {{{-1, -1, 0},
                                                        {1, -1, 0},
                                                        {-1, 1, 0},
                                                        {1, 1, 0},
                                                        {-1, 0, -1},
                                                        {1, 0, -1},
                                                        {-1, 0, 1},
                                                        {1, 0, 1},
                                                        {0, -1, -1},
                                                        {0, 1, -1},
                                                        {0, -1, 1},
                                                        {0, 1, 1}}};

  std::uint64_t row_sites;
  std::uint64_t layer_rows;

  // A row of sites is two steps long for each of them.
  explicit SpaceSites(std::uint64_t count)
      : row_sites(grid_side(2 * std::max<std::uint64_t>(count, 1), 3) / 2),
        layer_rows(grid_side((count + row_sites - 1) / row_sites, 2)) {}

  [[nodiscard]] Site operator()(std::uint64_t number) const {
    const std::uint64_t row = number / row_sites;
    const std::uint64_t y = row % layer_rows;
    const std::uint64_t z = row / layer_rows;
    const std::uint64_t x = 2 * (number % row_sites) + (y + z) % 2;
    return {static_cast<std::int64_t>(x), static_cast<std::int64_t>(y),
            static_cast<std::int64_t>(z)};
  }
};

/// The densest packing of discs, row by row through a square.
struct PlaneSites {
  static constexpr int kDimension = 2;
  static constexpr Point<3> kStep = {kSpacing / 2, kSpacing * 0x1.bb67ae8584caap-1, 0};
  static constexpr std::array<Site, 6> kNeighbours = {
      {{-1, -1, 0}, {1, -1, 0}, {-2, 0, 0}, {2, 0, 0}, {-1, 1, 0}, {1, 1, 0}}};

  std::uint64_t row_sites;

  // Rows lie closer than the sites of a row, by 0.866 = 13 / 15.
  explicit PlaneSites(std::uint64_t count) : row_sites(grid_side(count / 15 * 13 + 1, 2)) {}

  [[nodiscard]] Site operator()(std::uint64_t number) const {
    const std::uint64_t y = number / row_sites;
    const std::uint64_t x = 2 * (number % row_sites) + y % 2;
    return {static_cast<std::int64_t>(x), static_cast<std::int64_t>(y), 0};
  }
};

template <typename Sites>
class Packing {
 public:
  Packing(std::uint64_t seed, std::uint64_t count)
      : seed_(seed), sites_(count), order_(seed, count) {}

  Point<3> operator()(std::uint64_t i) const {
    const Site site = sites_(order_(i));
    const Site push = sum_to_large_neighbours(site);
    const Point<3> tremble = in_ball(Random::of_point(seed_, i));
    Point<3> p{};
    for (int k = 0; k < Sites::kDimension; ++k) {
      p[k] = Sites::kStep[k] *
                 (static_cast<double>(site[k]) - kPush / kSpacing * static_cast<double>(push[k])) +
             kTremble * tremble[k];
    }
    return p;
  }

 private:
  /// Sites beyond the sides of the cube count, too: it is cut out of a packing without end.
  [[nodiscard]] Site sum_to_large_neighbours(const Site& site) const {
    Site sum{};
    for (const Site& offset : Sites::kNeighbours) {
      const std::int64_t large =
          is_large({site[0] + offset[0], site[1] + offset[1], site[2] + offset[2]}) ? 1 : 0;
      for (int k = 0; k < Sites::kDimension; ++k) sum[k] += large * offset[k];
    }
    return sum;
  }

  [[nodiscard]] bool is_large(const Site& site) const {
    constexpr int kAxisBits = 64 / Sites::kDimension;
    std::uint64_t number = 0;
    for (int k = Sites::kDimension - 1; k >= 0; --k) {
      number = (number << kAxisBits) + static_cast<std::uint64_t>(site[k]);
    }
    return Random(~seed_, number).uniform() < kLargeShare;
  }

  /// A uniform point of the unit ball or disc.
  [[nodiscard]] static Point<3> in_ball(Random random) {
    while (true) {
      Point<3> p{};
      double squared_norm = 0;
      for (int k = 0; k < Sites::kDimension; ++k) {
        p[k] = 2 * random.uniform() - 1;
        squared_norm += p[k] * p[k];
      }
      if (squared_norm < 1) return p;
    }
  }

  std::uint64_t seed_;
  Sites sites_;
  Shuffle order_;
};

}  // namespace

std::unique_ptr<PointGenerator> make_packing(const GeneratorOptions& options) {
  const auto [family, count, dimension, seed] = options;
  if (dimension == 2) return make_indexed(options, Packing<PlaneSites>(seed, count));
  return make_indexed(options, Packing<SpaceSites>(seed, count));
}

}  // namespace spillway::generators
