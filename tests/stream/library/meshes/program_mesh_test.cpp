// A program's own mesh, as the engine reads it.

#include "stream/library/meshes/program_mesh.h"

#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "tests/error_facts.h"

namespace spillway::test {
namespace {

/// Two triangles of a square in two blocks.
class Square final : public spillway::MeshSource {
 public:
  [[nodiscard]] MeshHeader header() const override { return {}; }
  bool read(MeshBlock& block) override {
    if (next_ == blocks.size()) return false;
    block = blocks[next_++];
    return true;
  }
  [[nodiscard]] MeshTotals totals() override { return told; }

  std::vector<MeshBlock> blocks = {
      {.first_vertex = 0,
       .vertices = {{0, 0, 1}, {1, 0, 2}, {0, 1, 3}},
       .corners = {0, 1, 2},
       .finalized = {0}},
      {.first_vertex = 3, .vertices = {{1, 1, 4}}, .corners = {1, 3, 2}, .finalized = {1, 2, 3}}};
  MeshTotals told;

 private:
  std::size_t next_ = 0;
};

/// Reads all blocks; returns how many.
int read_all(ProgramMesh& mesh) {
  int blocks = 0;
  for (MeshStreamBlock block; mesh.read(block);) ++blocks;
  return blocks;
}

TEST(ProgramMesh, CountsWhatItsTotalsLeaveOpen) {
  Square square;
  ProgramMesh mesh(square);
  EXPECT_EQ(read_all(mesh), 2);
  EXPECT_EQ(mesh.totals(), (MeshTotals{.vertices = 4, .simplices = 2}));
  EXPECT_FALSE(mesh.has_hash());
}

TEST(ProgramMesh, HasAHashIfThatAndTheHullAreTold) {
  Square square;
  square.told = {.vertices = 4,
                 .simplices = 2,
                 .hull_facets = 4,
                 .points = 5,
                 .duplicates = 1,
                 .canonical_hash = 0x1234};
  ProgramMesh mesh(square);
  read_all(mesh);
  EXPECT_EQ(mesh.totals(), square.told);
  EXPECT_TRUE(mesh.has_hash());
}

TEST(ProgramMesh, RefusesTotalsThatAreNotWhatHasCome) {
  for (const MeshTotals& wrong :
       {MeshTotals{.vertices = 5}, MeshTotals{.vertices = 3}, MeshTotals{.simplices = 1}}) {
    Square square;
    square.told = wrong;
    ProgramMesh mesh(square);
    const auto error = thrown_by([&] { read_all(mesh); });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->code(), ErrorCode::kInvalidArgument);
  }
}

TEST(ProgramMesh, RefusesBlocksThatCannotBe) {
  Square square;
  square.blocks[1].corners[0] = 0;
  ProgramMesh mesh(square);
  MeshStreamBlock block;
  EXPECT_TRUE(mesh.read(block));
  const auto error = thrown_by([&] { mesh.read(block); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code(), ErrorCode::kInvalidArgument);
}

}  // namespace
}  // namespace spillway::test
