// Runs beside each other in one process, each with a limit of its own: together they keep to the
// sum, and what one of them keeps for itself the others neither use nor release.

#include <spillway/generate.h>
#include <spillway/triangulate.h>

#include <array>
#include <atomic>
#include <thread>

#include "src/runtime/process_memory.h"
#include "tests/stream/library/call_test.h"

namespace spillway::test {
namespace {

using RunsBeside = CallTest;

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20;
/// What the process takes besides: threads, tables, code that is run for the first time.
constexpr std::uint64_t kBesides = 14 * kMiB;

TEST_F(RunsBeside, KeepToTheSumOfTheirLimits) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "a sanitizer's own memory is not in the budget";
#endif
  const std::array<std::uint64_t, 2> limits = {40 * kMiB, 64 * kMiB};
  std::array<MeshTotals, 2> totals;
  const std::uint64_t before = runtime::resident_memory();
  std::vector<std::thread> threads;
  for (std::size_t r = 0; r < limits.size(); ++r) {
    threads.emplace_back([&, r] {
      const Context context({.memory = limits[r], .threads = 1, .scratch_folder = folder_});
      const auto points = generate_points({.family = "terrain", .count = 2'000'000, .seed = 7});
      const auto mesh = create_mesh(file("mesh" + std::to_string(r) + ".spm"), {}, context);
      totals[r] = triangulate(*points, *mesh, {}, context).mesh;
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(totals[0], totals[1]);
  EXPECT_LE(runtime::peak_memory(), before + limits[0] + limits[1] + limits.size() * kBesides);
}

TEST_F(RunsBeside, BeginAndEndAsTheyLikeWithOneResult) {
  const auto hash_of = [&](unsigned threads) {
    const Context context({.memory = "64M", .threads = threads, .scratch_folder = folder_});
    const auto points = generate_points({.count = 30'000, .seed = 3});
    const auto sink = mesh_to([](const MeshBlock&) {});
    return triangulate(*points, *sink, {.tile_points = 2000}, context).mesh.canonical_hash;
  };
  const std::uint64_t expected = hash_of(1);
  std::atomic<int> wrong = 0;
  std::vector<std::thread> threads;
  for (unsigned t = 0; t < 4; ++t) {
    threads.emplace_back([&, t] {
      for (int round = 0; round < 6; ++round) {
        if (hash_of(1 + (t + round) % 2) != expected) ++wrong;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, 0);
}

/// A run within a run: what the inner one releases at its end is its own.
TEST_F(RunsBeside, MayBeBegunByASinkOfAnother) {
  const Context context({.memory = "64M", .threads = 2, .scratch_folder = folder_});
  std::uint64_t inner = 0;
  const auto sink = mesh_to([&](const MeshBlock&) {
    if (inner != 0) return;
    const auto points = generate_points({.count = 5'000});
    const auto nothing = mesh_to([](const MeshBlock&) {});
    inner = triangulate(*points, *nothing, {}, context).mesh.simplices;
  });
  const auto points = generate_points({.count = 50'000});
  EXPECT_GT(triangulate(*points, *sink, {.tile_points = 3000}, context).mesh.simplices, 90'000U);
  EXPECT_GT(inner, 9'000U);
}

}  // namespace
}  // namespace spillway::test
