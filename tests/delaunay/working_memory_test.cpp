#include "src/delaunay/common/working_memory.h"

#include <gtest/gtest.h>

namespace spillway::detail {
namespace {

constexpr std::size_t kUnit = 64;  ///< blocks are multiples of it

class KeptBlocksTest : public testing::Test {
 protected:
  KeptBlocksTest() {
    for (const std::size_t units : {30, 10, 20}) {
      keep_block(BlockUse::kSimplices, Block::of(units * kUnit));
    }
  }
  ~KeptBlocksTest() override { release_kept_blocks(); }
};

TEST_F(KeptBlocksTest, LendTheSmallestThatIsLargeEnough) {
  EXPECT_EQ(BorrowedBlock(BlockUse::kSimplices, 11 * kUnit)->capacity(), 20 * kUnit);
  EXPECT_EQ(BorrowedBlock(BlockUse::kSimplices, 20 * kUnit)->capacity(), 20 * kUnit);
  const BorrowedBlock first(BlockUse::kSimplices, 1);
  BorrowedBlock second(BlockUse::kSimplices, 1);
  EXPECT_EQ(second->capacity(), 20 * kUnit);
}

TEST_F(KeptBlocksTest, LendTheLargestIfNoneIsLargeEnough) {
  EXPECT_EQ(BorrowedBlock(BlockUse::kSimplices, 31 * kUnit)->capacity(), 30 * kUnit);
}

TEST_F(KeptBlocksTest, LendNothingForAnotherUse) {
  EXPECT_EQ(BorrowedBlock(BlockUse::kPoints, 1)->capacity(), 0U);
}

TEST_F(KeptBlocksTest, AreTakenForGoodOnlyIfTheyFitWell) {
  EXPECT_EQ(kept_or_new_block(BlockUse::kSimplices, 18 * kUnit).capacity(), 20 * kUnit);
  EXPECT_EQ(kept_or_new_block(BlockUse::kSimplices, 18 * kUnit).capacity(), 18 * kUnit);
}

TEST_F(KeptBlocksTest, AreGoneWhenReleased) {
  release_kept_blocks();
  EXPECT_EQ(BorrowedBlock(BlockUse::kSimplices, 1)->capacity(), 0U);
}

}  // namespace
}  // namespace spillway::detail
