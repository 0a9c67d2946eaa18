#include "src/runtime/page_pool.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <thread>
#include <vector>

namespace spillway::test {
namespace {

std::vector<PagePool::Page> pages(PagePool& pool, std::size_t count) {
  std::vector<PagePool::Page> taken(count);
  for (PagePool::Page& page : taken) page = pool.take();
  return taken;
}

TEST(PagePool, GivesPagesOfWhichNoTwoAreOne) {
  PagePool pool;
  const std::vector<PagePool::Page> taken = pages(pool, 3000);
  for (std::size_t p = 0; p < taken.size(); ++p) {
    std::memset(taken[p].get(), static_cast<int>(p % 251), PagePool::kPageBytes);
  }
  for (std::size_t p = 0; p < taken.size(); ++p) {
    const auto value = static_cast<std::byte>(p % 251);
    ASSERT_EQ(reinterpret_cast<std::uintptr_t>(taken[p].get()) % PagePool::kPageBytes, 0U);
    ASSERT_EQ(std::count(taken[p].get(), taken[p].get() + PagePool::kPageBytes, value),
              PagePool::kPageBytes);
  }
}

TEST(PagePool, KeepsWhatIsPutBackUntilItIsGivenBack) {
  PagePool pool;
  std::byte* last = nullptr;
  {
    const std::vector<PagePool::Page> taken = pages(pool, 5);
    last = taken.back().get();
    *last = std::byte{7};
  }
  EXPECT_EQ(pool.kept(), 5U);
  EXPECT_EQ(pages(pool, 1).front().get(), last) << "the last one first";
  pool.give_back_free();
  EXPECT_EQ(pool.kept(), 0U);
  std::vector<PagePool::Page> again = pages(pool, 5);  // they can be used as before
  for (PagePool::Page& page : again) *page = std::byte{1};
  again.clear();
  EXPECT_EQ(pool.kept(), 5U);
}

TEST(PagePool, ServesManyThreads) {
  PagePool pool;
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&pool, t] {
      for (int round = 0; round < 50; ++round) {
        const std::vector<PagePool::Page> taken = pages(pool, 40);
        for (const PagePool::Page& page : taken) *page = static_cast<std::byte>(t);
        if (round % 10 == t) pool.give_back_free();
        for (const PagePool::Page& page : taken) ASSERT_EQ(*page, static_cast<std::byte>(t));
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
}

}  // namespace
}  // namespace spillway::test
