// A driver for very many small random sets over ranks, each against the triangulation in memory:
//   mpirun -n 5 build/release/bin/rank_sweep --sets 20000 --seed 1
// With --scale 20 tiles have enough points for sketches of curves and surfaces; one rank will do.
// Sets of all families, and small integers with many equal points; tiles, leaves, files, limits of
// borders and threads at random. Says at which seed a set fails, and ends.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <random>
#include <vector>

#include "src/generators/generators.h"
#include "tests/distributed/world.h"
#include "tests/stream/ranks/one_mesh.h"

namespace spillway::test {
namespace {

std::optional<distributed::Ranks> job;

using Random = std::mt19937_64;

std::uint64_t up_to(Random& random, std::uint64_t most) { return random() % (most + 1); }

EngineOptions random_options(Random& random, std::size_t scale) {
  EngineOptions options;
  options.threads = 1 + static_cast<unsigned>(up_to(random, 1));
  options.asked.tile_points = scale * (5 + up_to(random, 150));
  options.asked.leaf_points = scale * (4 + up_to(random, 40));
  if (up_to(random, 1) == 0) options.buffered_points = scale * (1 + up_to(random, 300));
  if (up_to(random, 3) > 0) options.gather_below = up_to(random, 60);
  options.asked.heights = std::array{Heights::kFirst, Heights::kHighest, Heights::kLowest,
                                     Heights::kMean}[up_to(random, 3)];
  return options;
}

/// Half of the sets have few points: fewer than ranks, or all at one of them.
template <int D>
std::vector<Point<D>> random_points(Random& random, std::size_t scale) {
  const bool small = up_to(random, 1) == 0;
  const std::uint64_t count = D + 1 + scale * up_to(random, small ? 20 : 400);
  if (up_to(random, 3) > 0) {
    const auto families = family_names();
    const Family family = family_by_name(families[up_to(random, families.size() - 1)]);
    const bool dense = D == 3 && family == Family::kLines;  // n^2/4 tetrahedra
    return generated_points<D>(
        {family, dense ? std::min<std::uint64_t>(count, 80) : count, D, random()});
  }
  std::vector<Point<D>> points(count);
  std::array<std::uint64_t, D> extent;
  for (std::uint64_t& most : extent) most = up_to(random, 1) == 0 ? 2 : 30;
  for (Point<D>& point : points) {
    for (int k = 0; k < D; ++k) point[k] = static_cast<double>(up_to(random, extent[k]));
  }
  return points;
}

template <int D>
void try_set(std::uint64_t seed, std::size_t scale) {
  Random random(seed);
  const std::vector<Point<D>> points = random_points<D>(random, scale);
  const std::size_t files = 1 + up_to(random, 8);
  expect_one_mesh<D>(points, files, random_options(random, scale));
}

/// Whether all sets are as they should be at this rank.
bool sweep(std::uint64_t first, std::uint64_t sets, std::size_t scale) {
  for (std::uint64_t seed = first; seed < first + sets; ++seed) {
    seed % 2 == 0 ? try_set<2>(seed, scale) : try_set<3>(seed, scale);
    if (::testing::Test::HasFailure()) {
      fmt::print(stderr, "rank {}: set {} is wrong\n", job->rank(), seed);
      return false;
    }
    if (job->rank() == 0 && (seed - first + 1) % 1000 == 0) {
      fmt::print("{} sets\n", seed - first + 1);
      std::fflush(stdout);
    }
  }
  return true;
}

}  // namespace

const distributed::Ranks& world() { return *job; }

}  // namespace spillway::test

int main(int argc, char** argv) {
  using namespace spillway::test;
  ::testing::InitGoogleTest(&argc, argv);
  std::uint64_t sets = 1000;
  std::uint64_t seed = 1;
  std::size_t scale = 1;
  CLI::App app("Triangulates random sets over ranks and in memory");
  app.add_option("--sets", sets, "How many");
  app.add_option("--seed", seed, "Of the first");
  app.add_option("--scale", scale, "So many times as many points, in tiles, leaves and buffers");
  CLI11_PARSE(app, argc, argv);
  job = distributed::Ranks::all();
  if (!sweep(seed, sets, scale)) distributed::abort_job(1);
  job.reset();
}
