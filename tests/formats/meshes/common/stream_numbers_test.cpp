#include "formats/meshes/common/stream_numbers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "formats/meshes/common/mesh_block.h"

namespace spillway::test {
namespace {

using ::testing::ElementsAre;

TEST(StreamNumbers, NewVerticesComeBeforeImportedOnes) {
  MeshStreamBlock block;
  block.vertices.resize(2);
  block.imported = {5, 3};
  const StreamNumbers numbers(100, block);
  ASSERT_EQ(numbers.size(), 4U);
  EXPECT_EQ(numbers[0], 100U);
  EXPECT_EQ(numbers[1], 101U);
  EXPECT_EQ(numbers[2], 5U);
  EXPECT_EQ(numbers[3], 3U);
}

TEST(StreamNumbers, AreAppendedToTheCornersOfAMesh) {
  MeshStreamBlock block;
  block.vertices.resize(1);
  block.imported = {0, 1};
  block.corners = {0, 1, 2, 2, 1, 0};
  std::vector<std::uint64_t> corners = {7};
  append_stream_numbers(block, 9, corners);
  EXPECT_THAT(corners, ElementsAre(7, 9, 0, 1, 1, 0, 9));
}

}  // namespace
}  // namespace spillway::test
