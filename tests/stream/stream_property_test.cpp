// The contract, out of core: whatever the tiles, the leaves, the memory and the threads, the stream
// holds CGAL's simplices, and the same bytes for any number of threads.

#include <gtest/gtest.h>

#include <string>

#include "formats/meshes/mesh_stream_writer.h"
#include "formats/meshes/obj/obj_format.h"
#include "formats/meshes/ply/ply_format.h"
#include "formats/meshes/sma/sma_format.h"
#include "formats/meshes/spm/spm_format.h"
#include "formats/meshes/vtu/vtu_format.h"
#include "src/delaunay/delaunay.h"
#include "src/error.h"
#include "src/generators/generators.h"
#include "tests/delaunay/cgal_oracle.h"
#include "tests/error_facts.h"
#include "tests/generators/family_cases.h"
#include "tests/stream/stream_runner.h"

namespace spillway::test {
namespace {

/// Tiny tiles that fit into memory, tiny tiles that all go to the disk, one tile of many leaves.
const std::vector<EngineOptions> kManyWays = {
    {.asked = {.tile_points = 20, .leaf_points = 8}, .threads = 1},
    {.asked = {.tile_points = 20, .leaf_points = 20}, .threads = 2, .buffered_points = 50},
    {.asked = {.tile_points = 150, .leaf_points = 30, .children = 4},
     .threads = 4,
     .buffered_points = 400},
    {.asked = {.leaf_points = 25}, .threads = 2},
};

template <int D>
void expect_equal_to_cgal(const std::vector<Point<D>>& points,
                          const std::vector<EngineOptions>& ways) {
  const auto expected = cgal_simplices<D>(points);
  const std::size_t hull_facets = cgal_hull_facets<D>(points);
  const std::string path = write_points<D>(points);
  for (const EngineOptions& options : ways) {
    SCOPED_TRACE(::testing::Message()
                 << points.size() << " points, tiles of " << options.asked.tile_points
                 << ", leaves of " << options.asked.leaf_points << ", " << options.threads
                 << " threads");
    if (expected.empty()) {
      EXPECT_THROW(run_stream<D>(path, options), Failure);
      continue;
    }
    const StreamRun run = run_stream<D>(path, options);
    ASSERT_TRUE(simplices_of<D>(run.mesh) == expected)
        << run.statistics.mesh.simplices << " simplices, CGAL has " << expected.size();
    EXPECT_EQ(run.statistics.mesh.hull_facets, hull_facets);
    EXPECT_EQ(run.statistics.mesh.simplices, expected.size());
    EXPECT_EQ(run.statistics.mesh.vertices + run.statistics.mesh.duplicates, points.size());
    EXPECT_EQ(run.mesh.live(), 0U) << "vertices never finalized";
  }
  std::filesystem::remove(path);
}

class StreamOfFamily : public ::testing::TestWithParam<FamilyCase> {};

TEST_P(StreamOfFamily, EqualsCgalForSmallSetsInTinyTiles) {
  for (const std::uint64_t n : {0, 1, 2, 3, 4, 5, 7, 12, 30, 100, 500, 2000}) {
    if (GetParam().dimension == 3 && n > 1000) continue;
    for (const std::uint64_t seed : {1, 2}) {
      const GeneratorOptions generate{GetParam().family, n, GetParam().dimension, seed};
      SCOPED_TRACE(::testing::Message() << "seed " << seed);
      if (GetParam().dimension == 2) {
        expect_equal_to_cgal<2>(generated_points<2>(generate), kManyWays);
      } else {
        expect_equal_to_cgal<3>(generated_points<3>(generate), kManyWays);
      }
    }
  }
}

TEST_P(StreamOfFamily, EqualsCgalForLargeSetsThatSpill) {
  const bool dense = GetParam().dimension == 3 && GetParam().family == Family::kLines;
  const bool slow = GetParam().family == Family::kCollinear;  // CGAL takes quadratic time
  const std::uint64_t n = dense ? 500 : slow ? 2'000 : GetParam().dimension == 2 ? 60'000 : 10'000;
  const GeneratorOptions generate{GetParam().family, n, GetParam().dimension, 7};
  const std::vector<EngineOptions> ways = {
      {.asked = {.tile_points = n / 7, .leaf_points = n / 40},
       .threads = 2,
       .buffered_points = n / 5},
      {.asked = {.tile_points = n / 3}, .threads = 4, .buffered_points = n / 2}};
  if (GetParam().dimension == 2) {
    expect_equal_to_cgal<2>(generated_points<2>(generate), ways);
  } else {
    expect_equal_to_cgal<3>(generated_points<3>(generate), ways);
  }
}

/// The blocks of a set out of core.
std::vector<MeshStreamBlock> blocks_of(const GeneratorOptions& generate,
                                       const EngineOptions& options) {
  if (generate.dimension == 2) {
    const std::string path = write_points<2>(generated_points<2>(generate));
    return run_stream<2>(path, options).mesh.blocks;
  }
  const std::string path = write_points<3>(generated_points<3>(generate));
  return run_stream<3>(path, options).mesh.blocks;
}

/// The same for one thread and for several.
void expect_same_blocks(const GeneratorOptions& generate, EngineOptions options) {
  options.threads = 1;
  const std::vector<MeshStreamBlock> once = blocks_of(generate, options);
  for (const unsigned threads : {2U, 4U}) {
    options.threads = threads;
    const auto again = blocks_of(generate, options);
    ASSERT_EQ(once.size(), again.size());
    for (std::size_t b = 0; b < once.size(); ++b) {
      ASSERT_EQ(once[b].vertices, again[b].vertices);
      ASSERT_EQ(once[b].imported, again[b].imported);
      ASSERT_EQ(once[b].corners, again[b].corners);
      ASSERT_EQ(once[b].finalized, again[b].finalized);
    }
  }
}

TEST_P(StreamOfFamily, GivesTheSameBlocksForAnyThreadCount) {
  const GeneratorOptions generate{GetParam().family, 700, GetParam().dimension, 3};
  try {
    expect_same_blocks(generate,
                       {.asked = {.tile_points = 90, .leaf_points = 20}, .buffered_points = 200});
  } catch (const Failure&) {
    GTEST_SKIP() << "no simplices in this dimension";
  }
}

TEST(StreamOfSurface, GivesTheSameBlocksForAnyThreadCountByItsSketches) {
  for (const int dimension : {2, 3}) {
    for (const Family family : {Family::kEllipsoid, Family::kScan}) {
      if (dimension == 2 && family == Family::kScan) continue;
      for (const std::size_t buffered : {4'000, 100'000}) {
        SCOPED_TRACE(::testing::Message() << dimension << "D, " << buffered << " points wait");
        expect_same_blocks(
            {family, 12'000, dimension, 3},
            {.asked = {.tile_points = 2'500, .leaf_points = 400}, .buffered_points = buffered});
      }
    }
  }
}

/// Points of a circle or a sphere: all of them stay in the border, and on the hull, to the end.
template <int D>
std::string write_round_points(std::uint64_t count) {
  return write_points<D>(generated_points<D>({Family::kCircle, count, D, 5}));
}

template <int D>
void expect_written_in(const std::vector<const MeshFormat*>& formats) {
  const std::string path = write_round_points<D>(3000);
  MeshStreamHeader header;
  header.dimension = D;
  for (const MeshFormat* const format : formats) {
    SCOPED_TRACE(::testing::Message() << D << "D, format " << format->name);
    JoinedInputs source(disk(), {path}, {.dimension = D});
    const auto scratch = make_scratch_folder(::testing::TempDir(), std::nullopt);
    const std::string mesh = path + ".mesh";
    const auto writer = open_mesh_stream_writer(disk(), mesh, *format, header, *scratch);
    QuietSetup setup({.asked = {.tile_points = 700, .leaf_points = 100}, .threads = 2});
    const RunStatistics statistics = triangulate_stream<D>(source, *writer, setup);
    EXPECT_NO_THROW(writer->finish(statistics.mesh));
    std::filesystem::remove(mesh);
  }
  std::filesystem::remove(path);
}

TEST(StreamOfBorderOnly, IsWrittenInEveryKindOfFormat) {
  expect_written_in<2>({&kSpmMesh, &kSmaMesh, &kPlyMesh, &kObjMesh});
  expect_written_in<3>({&kSpmMesh, &kVtuMesh});
}

template <int D>
void expect_named_memory_is_enough(std::uint64_t points, std::uint64_t memory) {
  const std::string path = write_round_points<D>(points);
  const ErrorFacts facts = facts_of([&] { run_stream<D>(path, {.threads = 2}, memory); });
  ASSERT_EQ(facts.remedy, Remedy::kMemory);
  // In space nobody knows for sure, but it has to be right.
  const std::uint64_t enough = D == 2 ? facts.enough : facts.perhaps;
  ASSERT_GT(enough, memory);
  EXPECT_LE(enough, (D == 2 ? 2'000 : 2'500) * points) << "bytes";
  EXPECT_NO_THROW(run_stream<D>(path, {.threads = 2}, enough));
  EXPECT_NO_THROW(
      run_stream<D>(path, {.asked = {.tile_points = points / 5}, .threads = 2}, enough));
  std::filesystem::remove(path);
}

TEST(StreamOfBorderOnly, IsRefusedWithTheMemoryThatIsEnough) {
  expect_named_memory_is_enough<2>(90'000, std::uint64_t{32} << 20);
  expect_named_memory_is_enough<3>(70'000, std::uint64_t{96} << 20);
}

INSTANTIATE_TEST_SUITE_P(Families, StreamOfFamily, ::testing::ValuesIn(all_family_cases()),
                         family_case_name);

}  // namespace
}  // namespace spillway::test
