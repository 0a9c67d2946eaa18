#include "src/delaunay/common/working_memory.h"

#include <gtest/gtest.h>

namespace spillway::test {
namespace {

constexpr std::size_t kUnit = 64;  ///< slabs are multiples of it

class KeptSlabsTest : public ::testing::Test {
 protected:
  KeptSlabsTest() {
    for (const std::size_t units : {30, 10, 20}) {
      keep_slab(SlabUse::kSimplices, Slab::of(units * kUnit));
    }
  }
  ~KeptSlabsTest() override { release_kept_slabs(); }
};

TEST_F(KeptSlabsTest, LendTheSmallestThatIsLargeEnough) {
  EXPECT_EQ(BorrowedSlab(SlabUse::kSimplices, 11 * kUnit)->capacity(), 20 * kUnit);
  EXPECT_EQ(BorrowedSlab(SlabUse::kSimplices, 20 * kUnit)->capacity(), 20 * kUnit);
  const BorrowedSlab first(SlabUse::kSimplices, 1);
  BorrowedSlab second(SlabUse::kSimplices, 1);
  EXPECT_EQ(second->capacity(), 20 * kUnit);
}

TEST_F(KeptSlabsTest, LendTheLargestIfNoneIsLargeEnough) {
  EXPECT_EQ(BorrowedSlab(SlabUse::kSimplices, 31 * kUnit)->capacity(), 30 * kUnit);
}

TEST_F(KeptSlabsTest, LendNothingForAnotherUse) {
  EXPECT_EQ(BorrowedSlab(SlabUse::kPoints, 1)->capacity(), 0U);
}

TEST_F(KeptSlabsTest, AreTakenForGoodOnlyIfTheyFitWell) {
  EXPECT_EQ(kept_or_new_slab(SlabUse::kSimplices, 18 * kUnit).capacity(), 20 * kUnit);
  EXPECT_EQ(kept_or_new_slab(SlabUse::kSimplices, 18 * kUnit).capacity(), 18 * kUnit);
}

TEST_F(KeptSlabsTest, AreGoneWhenReleased) {
  release_kept_slabs();
  EXPECT_EQ(BorrowedSlab(SlabUse::kSimplices, 1)->capacity(), 0U);
}

TEST_F(KeptSlabsTest, AreKeptIfTheyAreNotLargerWhenTheLargerOnesAreReleased) {
  release_kept_slabs(20 * kUnit);
  EXPECT_EQ(BorrowedSlab(SlabUse::kSimplices, 30 * kUnit)->capacity(), 20 * kUnit);
  release_kept_slabs(9 * kUnit);
  EXPECT_EQ(BorrowedSlab(SlabUse::kSimplices, 1)->capacity(), 0U);
}

}  // namespace
}  // namespace spillway::test
