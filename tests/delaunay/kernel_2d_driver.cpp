// Compares the 2D kernel with CGAL on small hard point sets, for as long as asked. Prints how many
// sets were equal, or the first that was not, and then exits with 1.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdint>

#include "tests/delaunay/kernel_2d_sets.h"

int main(int argc, char** argv) {
  int dimension = 2;
  double seconds = 10;
  std::uint64_t seed = 1;
  CLI::App app("Compares the base-case kernel with CGAL on hard point sets");
  app.add_option("--dim", dimension, "Dimension")->check(CLI::Range(2, 2));
  app.add_option("--seconds", seconds, "How long");
  app.add_option("--seed", seed, "Of the first set; each next one has the next");
  CLI11_PARSE(app, argc, argv);
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>(seconds);
  std::uint64_t sets = 0;
  for (; Clock::now() < end; ++sets, ++seed) {
    const auto points = spillway::hard_set(seed);
    const std::string fault = spillway::compare_kernel_with_cgal(points, seed);
    if (fault.empty()) continue;
    fmt::print("seed {}: {}; after {} equal sets. Points:\n", seed, fault, sets);
    for (const auto& p : points) fmt::print("{:a} {:a}\n", p[0], p[1]);
    return 1;
  }
  fmt::print("{} sets equal, the last of seed {}\n", sets, seed - 1);
}
