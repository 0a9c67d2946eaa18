#include "src/runtime/process_memory.h"

#include <gtest/gtest.h>
#include <sys/mman.h>

#include <cstddef>
#include <cstdint>

namespace spillway::test {
namespace {

constexpr std::size_t kMiB = std::size_t{1} << 20;

void* map(std::size_t bytes, int flags) {
  return ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | flags, -1, 0);
}

TEST(ProcessMemory, RisesAndFallsWithWhatIsInUseAndThePeakStays) {
  constexpr std::size_t kBytes = 64 * kMiB;
  constexpr std::size_t kSlack = 16 * kMiB;  // the system counts in batches
  const std::uint64_t before = resident_memory();
  ASSERT_GT(before, 0U);
  void* const reserved = map(kBytes, 0);
  ASSERT_NE(reserved, MAP_FAILED);
  EXPECT_LT(resident_memory(), before + kSlack) << "what is only reserved does not count";
  void* const used = map(kBytes, MAP_POPULATE);
  ASSERT_NE(used, MAP_FAILED);
  EXPECT_GT(resident_memory(), before + kBytes - kSlack);
  ::munmap(used, kBytes);
  ::munmap(reserved, kBytes);
  EXPECT_LT(resident_memory(), before + kSlack);
  EXPECT_GT(peak_memory(), before + kBytes - kSlack);
}

}  // namespace
}  // namespace spillway::test
