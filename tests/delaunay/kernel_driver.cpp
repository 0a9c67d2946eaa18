// Compares the own kernels with CGAL on small hard point sets, for as long as asked. Prints how
// many sets were equal, or the first that was not, and then exits with 1.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdint>

#include "tests/delaunay/kernel_sets.h"

namespace spillway::test {
namespace {

template <int D>
int compare(double seconds, std::uint64_t count, std::uint64_t seed) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>(seconds);
  std::uint64_t sets = 0;
  for (; count > 0 ? sets < count : Clock::now() < end; ++sets, ++seed) {
    const std::vector<Point<D>> points = hard_set<D>(seed);
    const std::string fault = compare_kernel_with_cgal<D>(points, seed);
    if (fault.empty()) continue;
    fmt::print("seed {}: {}; after {} equal sets. Points:\n", seed, fault, sets);
    for (const Point<D>& p : points) {
      for (const double c : p) fmt::print("{:a} ", c);
      fmt::print("\n");
    }
    return 1;
  }
  fmt::print("{} sets equal, the last of seed {}\n", sets, seed - 1);
  return 0;
}

}  // namespace
}  // namespace spillway::test

int main(int argc, char** argv) {
  int dimension = 2;
  double seconds = 10;
  std::uint64_t count = 0;
  std::uint64_t seed = 1;
  CLI::App app("Compares the base-case kernels with CGAL on hard point sets");
  app.add_option("--dim", dimension, "Dimension")->check(CLI::Range(2, 3));
  app.add_option("--seconds", seconds, "How long");
  app.add_option("--sets", count, "How many sets, instead of how long");
  app.add_option("--seed", seed, "Of the first set; each next one has the next");
  CLI11_PARSE(app, argc, argv);
  return dimension == 2 ? spillway::test::compare<2>(seconds, count, seed)
                        : spillway::test::compare<3>(seconds, count, seed);
}
