// The checker's vertices that may still be needed: as few slots as there are, and no vertex that
// has not come or comes no more.

#include "stream/checker/needed_vertices.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "src/error.h"

namespace spillway::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

/// A block of new vertices at (first, 0), (first + 1, 0), ..., and what it imports and finalizes.
MeshStreamBlock block_of(std::size_t fresh, std::vector<std::uint64_t> imported,
                         std::vector<std::uint32_t> finalized) {
  MeshStreamBlock block;
  block.vertices.resize(fresh);
  block.imported = std::move(imported);
  block.finalized = std::move(finalized);
  return block;
}

struct Entered {
  std::vector<Point<2>> points;
  std::vector<std::uint32_t> slots;
};

Entered enter(NeededVertices<2>& open, const MeshStreamBlock& block) {
  Entered entered;
  for (std::size_t v = 0; v < block.vertices.size(); ++v) {
    entered.points.push_back({static_cast<double>(open.announced() + v), 0});
  }
  open.enter(block, entered.points, entered.slots);
  return entered;
}

TEST(NeededVertices, HaveNumbersSlotsAndPoints) {
  NeededVertices<2> open;
  const Entered first = enter(open, block_of(3, {}, {}));
  EXPECT_EQ(open.announced(), 3U);
  const Entered second = enter(open, block_of(1, {2, 0}, {}));
  EXPECT_THAT(second.points, ElementsAre(Point<2>{3, 0}, Point<2>{2, 0}, Point<2>{0, 0}));
  EXPECT_EQ(second.slots[1], first.slots[2]);
  EXPECT_EQ(second.slots[2], first.slots[0]);
  EXPECT_EQ(open[second.slots[0]].number, 3U);
  EXPECT_EQ(open.peak(), 4U);
}

TEST(NeededVertices, SlotsAreUsedAgainOnceTheyAreFree) {
  NeededVertices<2> open;
  for (int block = 0; block < 100; ++block) {
    const Entered entered = enter(open, block_of(2, {}, {0, 1}));
    for (const std::uint32_t slot : entered.slots) {
      EXPECT_FALSE(open[slot].finalized);
      open.finalize(slot);
    }
  }
  EXPECT_EQ(open.announced(), 200U);
  EXPECT_EQ(open.peak(), 2U);
}

TEST(NeededVertices, AHeldOneStaysThoughItIsFinalized) {
  NeededVertices<2> open;
  const Entered first = enter(open, block_of(1, {}, {0}));
  const std::uint32_t held = first.slots[0];
  open.hold(held);
  open.hold(held);
  open.finalize(held);
  EXPECT_NE(enter(open, block_of(1, {}, {})).slots[0], held);
  open.release(held);
  EXPECT_NE(enter(open, block_of(1, {}, {})).slots[0], held);
  open.release(held);
  EXPECT_EQ(enter(open, block_of(1, {}, {})).slots[0], held);
}

TEST(NeededVertices, ThoseThatAreNeverFinalizedAreFound) {
  NeededVertices<2> open;
  const Entered entered = enter(open, block_of(4, {}, {1, 3}));
  open.finalize(entered.slots[1]);
  open.finalize(entered.slots[3]);
  std::vector<std::uint64_t> left;
  open.for_each_not_finalized([&left](const auto& vertex) { left.push_back(vertex.number); });
  EXPECT_THAT(left, UnorderedElementsAre(0, 2));
}

std::string error_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const Failure& error) {
    return error.what();
  }
  return "no error";
}

TEST(NeededVertices, RefuseAVertexThatHasNotComeOrComesNoMore) {
  NeededVertices<2> open;
  EXPECT_THAT(error_of([&] { enter(open, block_of(1, {9}, {})); }), HasSubstr("uses vertex 9"));
  NeededVertices<2> other;
  enter(other, block_of(2, {}, {1}));
  EXPECT_THAT(error_of([&] { enter(other, block_of(1, {1}, {})); }), HasSubstr("uses vertex 1"));
}

TEST(NeededVertices, RefuseToFinalizeTwice) {
  NeededVertices<2> open;
  const Entered entered = enter(open, block_of(6, {}, {}));
  open.finalize(entered.slots[5]);
  EXPECT_THAT(error_of([&] { open.finalize(entered.slots[5]); }),
              HasSubstr("finalizes vertex 5 twice"));
}

}  // namespace
}  // namespace spillway::test
