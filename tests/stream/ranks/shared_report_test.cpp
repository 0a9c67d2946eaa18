// The report of a run over ranks: sums, longest times, and what each rank did.

#include "stream/ranks/shared_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>

#include "src/runtime/stage_times.h"
#include "tests/distributed/world.h"

namespace spillway::test {
namespace {

using ::testing::Each;
using ::testing::Field;
using ::testing::SizeIs;

/// 1 + 2 + ... + ranks.
std::uint64_t sum_of_ranks() {
  const auto ranks = static_cast<std::uint64_t>(world().size());
  return ranks * (ranks + 1) / 2;
}

/// What rank r has made: statistics that are multiples of r + 1, so that each sum is told apart. It
/// has merged at r + 1 levels, and waits the longer the lower its number is.
RankMesh mesh_of(int rank) {
  const auto n = static_cast<std::uint64_t>(rank + 1);
  RankMesh mesh;
  mesh.totals = {.vertices = 100,
                 .simplices = 190,
                 .hull_facets = 8,
                 .points = 110,
                 .duplicates = 10,
                 .canonical_hash = 0xABCD};
  mesh.left_out = 4;
  RunStatistics& statistics = mesh.statistics;
  statistics.mesh.vertices = 1000 * n;
  statistics.left_out = 7 * n;
  statistics.threads = 2;
  statistics.tile_points = 5000;
  statistics.leaf_points = 500;
  statistics.tiles = n;
  statistics.leaves = 2 * n;
  statistics.spilled_points = 3 * n;
  statistics.spilled_bytes = 4 * n;
  statistics.final_in_leaves = 5 * n;
  statistics.final_in_tiles = 6 * n;
  statistics.final_by_level.assign(n, 10);
  statistics.retriangulated = 7 * n;
  statistics.border_simplices = 8 * n;
  statistics.border_bytes = 9 * n;
  statistics.divided_points = 10 * n;
  statistics.tile_shapes = {20 * n, 30 * n, 40 * n};
  statistics.read_seconds = 1.0 * static_cast<double>(n);
  statistics.divide_seconds = 10.0 / static_cast<double>(n);
  statistics.triangulate_seconds = rank == 0 ? 5 : 3;
  for (const char* const stage : kStageNames) {
    statistics.stages.push_back({stage, 0.5 * static_cast<double>(n)});
  }
  RankMerge merge;
  merge.level = 1;
  merge.sent_bytes = 11 * n;
  merge.seconds = 0.25;
  mesh.merges.assign(n, merge);
  mesh.exchanged_points = 12 * n;
  mesh.exchanged_bytes = 13 * n;
  mesh.exchanged_messages = 14 * n;
  return mesh;
}

std::bitset<256> classes_of(int rank) { return std::bitset<256>().set(255 - rank); }

Report report_of_all() {
  const auto n = static_cast<std::uint64_t>(world().rank() + 1);
  return shared_report(
      mesh_of(world().rank()),
      {.read = 100 * n, .bounds = n, .lost = 2 * n, .other_classes = classes_of(world().rank())},
      world());
}

TEST(SharedReport, HasTheTotalsOfTheWholeMesh) {
  const Report report = report_of_all();
  EXPECT_EQ(report.mesh, mesh_of(0).totals);
  EXPECT_EQ(report.left_out, 4U);
}

TEST(SharedReport, SumsWhatIsCountedOverAllRanks) {
  const Report report = report_of_all();
  const std::uint64_t sum = sum_of_ranks();
  EXPECT_EQ(report.threads, 2U * static_cast<unsigned>(world().size()));
  EXPECT_EQ(report.tiles, sum);
  EXPECT_EQ(report.leaves, 2 * sum);
  EXPECT_EQ(report.spilled_points, 3 * sum);
  EXPECT_EQ(report.spilled_bytes, 4 * sum);
  EXPECT_EQ(report.final_in_leaves, 5 * sum);
  EXPECT_EQ(report.final_in_tiles, 6 * sum);
  EXPECT_EQ(report.retriangulated, 7 * sum);
  EXPECT_EQ(report.border_simplices, 8 * sum);
  EXPECT_EQ(report.border_bytes, 9 * sum);
  EXPECT_EQ(report.divided_points, 10 * sum);
  EXPECT_EQ(report.tile_shapes.up_to_twice, 20 * sum);
  EXPECT_EQ(report.tile_shapes.up_to_4_times, 30 * sum);
  EXPECT_EQ(report.tile_shapes.longer, 40 * sum);
  std::bitset<256> classes;
  for (int rank = 0; rank < world().size(); ++rank) classes |= classes_of(rank);
  EXPECT_EQ(
      report.points,
      (PointCounts{.read = 100 * sum, .bounds = sum, .lost = 2 * sum, .other_classes = classes}));
}

TEST(SharedReport, SumsLevelsThatNotAllRanksHave) {
  const Report report = report_of_all();
  const auto ranks = static_cast<std::uint64_t>(world().size());
  ASSERT_THAT(report.final_by_level, SizeIs(ranks));
  for (std::uint64_t level = 0; level < ranks; ++level) {
    EXPECT_EQ(report.final_by_level[level], 10 * (ranks - level)) << "level " << level;
  }
}

TEST(SharedReport, SumsTheTimesOfThreadsAndTakesTheLongestOfPhases) {
  const Report report = report_of_all();
  ASSERT_THAT(report.stages, SizeIs(kStageNames.size()));
  for (std::size_t s = 0; s < kStageNames.size(); ++s) {
    EXPECT_EQ(report.stages[s].stage, kStageNames[s]);
    EXPECT_EQ(report.stages[s].seconds, 0.5 * static_cast<double>(sum_of_ranks()));
  }
  EXPECT_EQ(report.read_seconds, world().size()) << "of the last rank";
  EXPECT_EQ(report.divide_seconds, 10) << "of the first rank";
  EXPECT_EQ(report.triangulate_seconds, 5);
}

TEST(SharedReport, TellsTheFirstRankWhatEachHasDone) {
  const RunSums sums = shared_sums(mesh_of(world().rank()), world());
  if (world().rank() != 0) {
    EXPECT_THAT(sums.ranks, SizeIs(0));
    return;
  }
  ASSERT_THAT(sums.ranks, SizeIs(static_cast<std::size_t>(world().size())));
  for (int rank = 0; rank < world().size(); ++rank) {
    const RankStatistics& told = sums.ranks[static_cast<std::size_t>(rank)];
    const RankMesh own = mesh_of(rank);
    EXPECT_EQ(told.run.mesh, own.statistics.mesh);
    EXPECT_EQ(told.run.left_out, own.statistics.left_out);
    EXPECT_EQ(told.run.threads, 2U);
    EXPECT_EQ(told.run.tile_points, 5000U);
    EXPECT_EQ(told.run.leaf_points, 500U);
    EXPECT_EQ(told.run.tiles, own.statistics.tiles);
    EXPECT_EQ(told.run.divided_points, own.statistics.divided_points);
    EXPECT_EQ(told.run.final_by_level, own.statistics.final_by_level);
    EXPECT_EQ(told.run.read_seconds, own.statistics.read_seconds);
    EXPECT_EQ(told.run.triangulate_seconds, own.statistics.triangulate_seconds);
    EXPECT_THAT(told.run.stages,
                Each(Field(&StageSeconds::seconds, own.statistics.stages[0].seconds)));
    EXPECT_GT(told.peak_memory, 0U);
    EXPECT_EQ(told.points_sent, own.exchanged_points);
    EXPECT_EQ(told.point_bytes_sent, own.exchanged_bytes);
    EXPECT_EQ(told.point_messages_sent, own.exchanged_messages);
    ASSERT_THAT(told.merges, SizeIs(own.merges.size()));
    EXPECT_EQ(told.merges.back().sent_bytes, own.merges.back().sent_bytes);
    EXPECT_EQ(told.merges.back().seconds, 0.25);
  }
}

}  // namespace
}  // namespace spillway::test
