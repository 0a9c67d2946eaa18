// The contract over ranks: whatever their number, all of them together make the triangulation that
// one process makes.

#include <gtest/gtest.h>

#include "src/generators/generators.h"
#include "tests/generators/family_cases.h"
#include "tests/stream/ranks/one_mesh.h"

namespace spillway::test {
namespace {

void expect_one_mesh(const FamilyCase& family, std::uint64_t count, std::uint64_t seed,
                     std::size_t files, const EngineOptions& options) {
  SCOPED_TRACE(::testing::Message() << count << " points, seed " << seed);
  const GeneratorOptions generate{family.family, count, family.dimension, seed};
  if (family.dimension == 2) {
    test::expect_one_mesh<2>(generated_points<2>(generate), files, options);
  } else {
    test::expect_one_mesh<3>(generated_points<3>(generate), files, options);
  }
}

class MeshOfRanks : public ::testing::TestWithParam<FamilyCase> {};

TEST_P(MeshOfRanks, EqualsThatOfOneProcessForSmallSets) {
  for (const std::uint64_t count : {3, 4, 5, 7, 12, 30, 100}) {
    expect_one_mesh(
        GetParam(), count, 1, 3,
        {.asked = {.tile_points = 20, .leaf_points = 8}, .threads = 2, .gather_below = count % 3});
  }
}

TEST_P(MeshOfRanks, EqualsThatOfOneProcessForManyTilesThatSpill) {
  const bool dense = GetParam().dimension == 3 && GetParam().family == Family::kLines;
  const std::uint64_t count = dense ? 200 : GetParam().dimension == 2 ? 4'000 : 1'200;
  expect_one_mesh(GetParam(), count, 2, 11,
                  {.asked = {.tile_points = 90, .leaf_points = 30},
                   .threads = 1,
                   .buffered_points = 200,
                   .gather_below = 40});
  expect_one_mesh(GetParam(), count, 3, 2, {.threads = 2});
}

INSTANTIATE_TEST_SUITE_P(Families, MeshOfRanks, ::testing::ValuesIn(all_family_cases()),
                         family_case_name);

TEST(RanksInThePipeline, GetAboutAsManyPointsEachAlsoOfSkewedSets) {
  for (const Family family : {Family::kNormal, Family::kClusters, Family::kTerrain}) {
    const auto points = generated_points<2>({family, 40'000, 2, 5});
    std::vector<std::string> paths;
    if (world().rank() == 0) paths = write_shared_points<2>(points, 9);
    world().barrier();
    const RankRunResult run = run_over_ranks<2>(paths, {.threads = 1});
    const double even = 40'000.0 / world().size();
    EXPECT_NEAR(static_cast<double>(run.mesh.statistics.mesh.points), even, 0.1 * even);
    for (const std::string& path : paths) std::filesystem::remove(path);
  }
}

TEST(RanksInThePipeline, CountOpenFacetsOfAllTogetherWhereLongEdgesAreLeftOut) {
  const auto points = generated_points<2>({Family::kUniform, 3'000, 2, 5});
  std::vector<std::string> paths;
  if (world().rank() == 0) paths = write_shared_points<2>(points, 5);
  world().barrier();
  const EngineOptions options{.asked = {.max_edge = 0.03, .tile_points = 200, .leaf_points = 50},
                              .threads = 1};
  const RankRunResult run = run_over_ranks<2>(paths, options);
  const std::string path = write_points<2>(points);
  const StreamRun alone = run_stream<2>(path, options);
  std::filesystem::remove(path);
  EXPECT_GT(run.mesh.left_out, 0U);
  EXPECT_EQ(run.mesh.left_out, alone.statistics.left_out);
  EXPECT_EQ(run.mesh.totals, alone.statistics.mesh);
  for (const std::string& p : paths) std::filesystem::remove(p);
}

TEST(RanksInThePipeline, SayWhatTheySentAndMerged) {
  const auto points = generated_points<2>({Family::kUniform, 20'000, 2, 5});
  std::vector<std::string> paths;
  if (world().rank() == 0) paths = write_shared_points<2>(points, 8);
  world().barrier();
  const RankRunResult run = run_over_ranks<2>(paths, {.threads = 1});
  std::uint64_t triangulated = 0;
  std::uint64_t exposed = 0;
  std::uint32_t level = 0;
  for (const RankMerge& merge : run.mesh.merges) {
    EXPECT_GT(merge.level, level) << "in the order of levels";
    level = merge.level;
    EXPECT_LE(merge.exposed_simplices, merge.border_simplices);
    EXPECT_LE(merge.retriangulated, merge.border_points);
    if (merge.ranks < world().size()) continue;
    triangulated = merge.retriangulated;
    exposed = merge.exposed_simplices;
  }
  std::vector<std::uint64_t> sums = {run.mesh.exchanged_points, triangulated, exposed};
  world().reduce(sums, distributed::Reduction::kSum);
  const bool has_others = world().size() > 1;
  EXPECT_EQ(run.mesh.merges.empty(), !has_others);
  EXPECT_EQ(sums[0] > 0, has_others);
  EXPECT_EQ(sums[2] > 0, has_others);
  if (has_others) {
    EXPECT_EQ(run.mesh.merges.back().ranks, world().size());
    EXPECT_EQ(sums[1], run.mesh.merges.back().border_points);
  }
  for (const std::string& path : paths) std::filesystem::remove(path);
}

}  // namespace
}  // namespace spillway::test
