// Pages that a run has put back stand for all freed memory: how many are kept can be told.

#include "src/runtime/freed_memory.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "src/runtime/page_pool.h"
#include "src/runtime/run_memory.h"

namespace spillway::test {
namespace {

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20;
constexpr std::size_t kPages = 2048;  // 8 MiB

class FreedMemoryTest : public ::testing::Test {
 protected:
  /// Uses memory and frees it.
  void use_pages() {
    std::vector<PagePool::Page> pages(kPages);
    for (PagePool::Page& page : pages) {
      page = pool().take();
      std::memset(page.get(), 1, PagePool::kPageBytes);
    }
  }
  static PagePool& pool() { return *RunMemory::current().get<PagePool>(); }

 private:
  RunScope run_;
};

TEST_F(FreedMemoryTest, IsKeptAsLongAsTheProcessIsWithinTheLimit) {
  FreedMemory freed(1024 * kMiB);
  use_pages();
  freed.give_back(0);
  freed.give_back(64 * kMiB);
  EXPECT_EQ(pool().kept(), kPages);
}

TEST_F(FreedMemoryTest, IsGivenBackWhereTheProcessHasOutgrownTheLimit) {
  FreedMemory freed(kMiB);
  use_pages();
  freed.give_back(0);
  EXPECT_EQ(pool().kept(), 0U);
}

TEST_F(FreedMemoryTest, IsGivenBackBeforeMoreIsTakenThanThereIsRoomFor) {
  FreedMemory freed(1024 * kMiB);
  use_pages();
  freed.give_back(2048 * kMiB);
  EXPECT_EQ(pool().kept(), 0U);
}

TEST_F(FreedMemoryTest, IsKeptUntilTheProcessHasGrownOnceMore) {
  FreedMemory freed(64 * kMiB);
  freed.give_back(2048 * kMiB);
  use_pages();
  freed.give_back(0);
  EXPECT_EQ(pool().kept(), kPages);
}

TEST_F(FreedMemoryTest, RunsBesideEachOtherMayHoldTheSumOfTheirLimits) {
  FreedMemory small(kMiB);
  {
    const FreedMemory beside(1024 * kMiB);
    use_pages();
    small.give_back(0);
    EXPECT_EQ(pool().kept(), kPages);
  }
  small.give_back(0);
  EXPECT_EQ(pool().kept(), 0U);
}

}  // namespace
}  // namespace spillway::test
