// Sorting on the disk: few and many runs, of any length, with little memory and with much.

#include "stream/source/thinning/point_runs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "src/error.h"

namespace spillway::test {
namespace {

std::vector<std::uint64_t> order_of_all(PointRuns& runs, std::size_t most) {
  std::vector<std::uint64_t> keys;
  std::vector<RunPoint> points;
  while (runs.next(points, most)) {
    EXPECT_LE(points.size(), most);
    for (const RunPoint& p : points) {
      EXPECT_EQ(p.point, (LatticePoint{1.0 * static_cast<double>(p.order), 2, 3}));
      EXPECT_EQ(p.index, p.order + 5);
      keys.push_back(p.order);
    }
  }
  EXPECT_FALSE(runs.next(points, most));
  return keys;
}

TEST(PointRuns, ComeMergedFromAnyNumberOfRunsWithAnyMemory) {
  std::mt19937 random(6);
  for (const std::size_t count : {0U, 1U, 2U, 3U, 5U, 40U}) {
    for (const std::uint64_t memory : {0U, 1U << 20, 1U << 28}) {
      std::vector<std::uint64_t> keys(count * 1000);
      std::iota(keys.begin(), keys.end(), 0U);
      std::shuffle(keys.begin(), keys.end(), random);
      const auto scratch = make_scratch_folder(::testing::TempDir(), std::nullopt);
      PointRuns runs(memory, *scratch);
      for (std::size_t begin = 0; begin < keys.size();) {
        // Empty ones, single points, and more than one piece.
        const std::size_t size = std::min<std::size_t>(
            keys.size() - begin, random() % 4 == 0 ? random() % 2 : random() % 9000);
        std::vector<RunPoint> run;
        for (std::size_t i = begin; i < begin + size; ++i) {
          run.push_back({keys[i], keys[i] + 5, 0, {1.0 * static_cast<double>(keys[i]), 2, 3}});
        }
        std::ranges::sort(run, {}, &RunPoint::order);
        runs.begin_run();
        runs.append(std::span(run).first(size / 3));
        runs.append(std::span(run).subspan(size / 3));
        begin += size;
      }
      std::ranges::sort(keys);
      EXPECT_EQ(order_of_all(runs, 777), keys);
    }
  }
}

TEST(PointRuns, TakeTheDiskOnceMoreAtMostWhileTheyAreMerged) {
  const auto scratch = make_scratch_folder(::testing::TempDir(), std::nullopt);
  PointRuns runs(0, *scratch);
  std::mt19937_64 random(1);
  for (std::uint64_t r = 0; r < 64; ++r) {
    runs.begin_run();
    for (std::uint64_t i = 0; i < 500; ++i) {
      runs.append(std::vector<RunPoint>{{i * 64 + r, random(), 0, {}}});
    }
  }
  const std::uint64_t written = scratch->bytes_written();
  std::vector<RunPoint> points;
  std::size_t count = 0;
  while (runs.next(points, 1000)) count += points.size();
  EXPECT_EQ(count, 32'000U);
  EXPECT_EQ(scratch->peak_bytes(), 2 * written);
}

TEST(PointRuns, AFullDiskIsAnError) {
  const auto scratch = make_scratch_folder(::testing::TempDir(), 100'000);
  PointRuns runs(1 << 20, *scratch);
  runs.begin_run();
  EXPECT_THROW(runs.append(std::vector<RunPoint>(20'000)), Failure);
}

}  // namespace
}  // namespace spillway::test
