// The vertices of a part of a mesh that stands for itself: every one once, those of other ranks
// repeated, and all of them known by their numbers in the whole.

#include "stream/ranks/part_file_numbers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace spillway::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// Two ranks' tiles of ten and five vertices, and two merges of two and one.
RankMesh whole(std::optional<std::uint32_t> own) {
  RankMesh mesh;
  mesh.sections = {{.rank = 0, .level = 0, .first_vertex = 0, .vertices = 10},
                   {.rank = 1, .level = 0, .first_vertex = 10, .vertices = 5},
                   {.rank = 0, .level = 1, .first_vertex = 15, .vertices = 2},
                   {.rank = 0, .level = 2, .first_vertex = 17, .vertices = 1}};
  mesh.own_section = own;
  return mesh;
}

LatticePoint point_of(std::uint64_t global) { return {static_cast<double>(global), 0, 0}; }

/// A block of a merge that uses vertices of other parts, by their numbers in the whole.
MergedSection merged(std::uint32_t section, std::uint64_t first, std::size_t fresh,
                     const std::vector<std::uint64_t>& imported, std::vector<std::uint32_t> corners,
                     bool index = false) {
  MergedSection result;
  result.section = section;
  for (std::size_t v = 0; v < fresh; ++v) {
    result.mesh.vertices.push_back(point_of(first + v));
    if (index) result.mesh.input_index.push_back(1000 + first + v);
  }
  for (const std::uint64_t v : imported) {
    result.mesh.imported.push_back(v);
    result.imported_vertices.push_back(point_of(v));
    if (index) result.imported_index.push_back(1000 + v);
  }
  result.mesh.corners = std::move(corners);
  return result;
}

std::vector<std::pair<std::uint64_t, std::uint64_t>> runs_of(const PartFileNumbers& numbers) {
  std::vector<std::pair<std::uint64_t, std::uint64_t>> runs;
  for (const IdRange& run : numbers.global_ids()) runs.emplace_back(run.first, run.count);
  return runs;
}

/// First number and count.
using Ids = std::pair<std::uint64_t, std::uint64_t>;

TEST(PartFileNumbers, BeginWithTheOwnTiles) {
  const RankMesh mesh = whole(1);
  const PartFileNumbers numbers(mesh);
  EXPECT_EQ(numbers.vertices(), 5U);
  EXPECT_THAT(runs_of(numbers), ElementsAre(Ids{10, 5}));
}

TEST(PartFileNumbers, OfARankWithoutTilesBeginWithNothing) {
  const RankMesh mesh = whole(std::nullopt);
  const PartFileNumbers numbers(mesh);
  EXPECT_EQ(numbers.vertices(), 0U);
  EXPECT_THAT(runs_of(numbers), IsEmpty());
}

TEST(PartFileNumbers, VerticesOfOthersAreNewOnesAndOwnOnesAreNot) {
  const RankMesh mesh = whole(0);
  PartFileNumbers numbers(mesh);
  MergedSection section = merged(2, 15, 2, {12, 3, 14}, {0, 1, 2, 2, 3, 4}, true);
  section.mesh.finalized = {0, 3, 4};
  const MeshStreamBlock block = numbers.take(std::move(section));
  EXPECT_THAT(block.vertices, ElementsAre(point_of(15), point_of(16), point_of(12), point_of(14)));
  EXPECT_THAT(block.input_index, ElementsAre(1015, 1016, 1012, 1014));
  EXPECT_THAT(block.imported, ElementsAre(3));
  EXPECT_THAT(block.corners, ElementsAre(0, 1, 2, 2, 4, 3));
  EXPECT_THAT(block.finalized, ElementsAre(0, 4, 3));
  EXPECT_EQ(numbers.vertices(), 14U);
  EXPECT_THAT(runs_of(numbers), ElementsAre(Ids{0, 10}, Ids{15, 2}, Ids{12, 1}, Ids{14, 1}));
}

TEST(PartFileNumbers, AVertexOfAnotherRankIsRepeatedOnce) {
  const RankMesh mesh = whole(0);
  PartFileNumbers numbers(mesh);
  numbers.take(merged(2, 15, 2, {12, 14}, {0, 2, 3}));
  const MeshStreamBlock block = numbers.take(merged(3, 17, 1, {12, 16, 0, 13}, {0, 1, 2, 3, 4, 0}));
  EXPECT_THAT(block.vertices, ElementsAre(point_of(17), point_of(13)));
  EXPECT_THAT(block.imported, ElementsAre(12, 11, 0))
      << "by their numbers in the part: repeated, of the merge before, of the tiles";
  EXPECT_THAT(block.corners, ElementsAre(0, 2, 3, 4, 1, 0));
  EXPECT_EQ(numbers.vertices(), 16U);
}

}  // namespace
}  // namespace spillway::test
