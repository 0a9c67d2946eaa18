// A mesh of one block as several: the same mesh, which a reader of streams takes.

#include "formats/meshes/common/divided_block.h"

#include <numeric>

#include "formats/meshes/spm/spm_format.h"
#include "tests/formats/meshes/attributed_mesh.h"

namespace spillway::test {
namespace {

/// A strip in one block, its simplices in any order, which then uses any vertices besides.
StreamedMesh shuffled_mesh(int dimension) {
  StreamedMesh mesh = strip(dimension, 300, 1000);
  add_input_index(mesh);
  add_attributes(mesh, every_type(), 9);
  std::vector<std::uint32_t>& corners = mesh.blocks[0].corners;
  std::mt19937 random(8);
  const std::size_t each = dimension + 1;
  for (std::size_t i = corners.size() / each - 1; i > 0; --i) {
    const std::size_t other = random() % i;
    std::swap_ranges(corners.begin() + i * each, corners.begin() + (i + 1) * each,
                     corners.begin() + other * each);
  }
  std::vector<std::uint32_t> far = {299, 0, 150, 7};
  corners.insert(corners.end(), far.begin(), far.begin() + each);
  ++mesh.totals.simplices;
  return mesh;
}

TEST(DividedBlock, IsTheSameMesh) {
  for (const int dimension : {2, 3}) {
    const StreamedMesh mesh = shuffled_mesh(dimension);
    const FlatMesh whole = flat(mesh);
    for (const std::size_t size : {1, 7, 100, 299, 300, 301}) {
      StreamedMesh parts = mesh;
      parts.blocks = divided(mesh.blocks[0], dimension + 1, every_type().record_size(), size);
      EXPECT_EQ(parts.blocks.size(), (300 + size - 1) / size);
      const FlatMesh read = flat(read_stream("-", stream_bytes(parts, kSpmMesh)));
      EXPECT_TRUE(read.vertices == whole.vertices);
      EXPECT_TRUE(read.input_index == whole.input_index);
      EXPECT_TRUE(read.attributes == whole.attributes);
      EXPECT_TRUE(read.simplices == whole.simplices);
      EXPECT_EQ(read.finalized.size(), 300U);
    }
  }
}

TEST(DividedBlock, FinalizesVerticesWhereTheyAreUsedLast) {
  MeshStreamBlock whole;
  whole.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {5, 5, 5}};
  whole.corners = {1, 3, 2, 0, 1, 2};
  const std::vector<MeshStreamBlock> blocks = divided(whole, 3, 0, 2);
  ASSERT_EQ(blocks.size(), 3U);
  EXPECT_TRUE(blocks[0].corners.empty());
  EXPECT_TRUE(blocks[0].finalized.empty());
  EXPECT_EQ(blocks[1].imported, (std::vector<std::uint64_t>{1, 0}));
  EXPECT_EQ(blocks[1].corners, (std::vector<std::uint32_t>{2, 1, 0, 3, 2, 0}));
  EXPECT_EQ(blocks[1].finalized, (std::vector<std::uint32_t>{0, 1, 2, 3}));
  EXPECT_EQ(blocks[2].finalized, (std::vector<std::uint32_t>{0}));
}

}  // namespace
}  // namespace spillway::test
