#include "src/delaunay/common/working_memory.h"

#include <sys/mman.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <new>
#include <utility>
#include <vector>

namespace spillway::detail {
namespace {

constexpr std::size_t kHugePage = std::size_t{1} << 21;
constexpr std::size_t kCacheLine = 64;

/// Calls give(first, bytes) for the huge pages that lie in a piece of memory, if there are any.
template <typename Give>
void for_huge_pages(std::byte* begin, std::byte* end, const Give& give) {
  const auto misfit = reinterpret_cast<std::uintptr_t>(begin) % kHugePage;
  std::byte* const first = misfit == 0 ? begin : begin + (kHugePage - misfit);
  if (end - first < static_cast<std::ptrdiff_t>(kHugePage)) return;
  give(first, static_cast<std::size_t>(end - first) / kHugePage * kHugePage);
}

struct KeptBlocks {
  std::mutex mutex;
  /// Guarded by `mutex`. The smallest come first.
  std::array<std::vector<Block>, 2> of_use;

  std::vector<Block>& operator[](BlockUse use) { return of_use[static_cast<std::size_t>(use)]; }

  static KeptBlocks& instance() {
    static KeptBlocks kept;
    return kept;
  }
};

using BlockPlace = std::vector<Block>::iterator;

BlockPlace smallest_with(std::size_t bytes, std::vector<Block>& blocks) {
  return std::lower_bound(
      blocks.begin(), blocks.end(), bytes,
      [](const Block& block, std::size_t size) { return block.capacity() < size; });
}

Block take(BlockPlace place, std::vector<Block>& blocks) {
  Block block = std::move(*place);
  blocks.erase(place);
  return block;
}

}  // namespace

void ask_for_huge_pages(void* memory, std::size_t bytes) {
  auto* const begin = static_cast<std::byte*>(memory);
  for_huge_pages(begin, begin + bytes,
                 [](std::byte* first, std::size_t size) { madvise(first, size, MADV_HUGEPAGE); });
}

/// Smaller pieces that are made of the memory later are not to take whole huge pages.
void Block::Free::operator()(std::byte* memory) const {
  for_huge_pages(memory, memory + bytes,
                 [](std::byte* first, std::size_t size) { madvise(first, size, MADV_NOHUGEPAGE); });
  std::free(memory);
}

Block Block::without_huge_pages(std::size_t bytes) {
  const std::size_t alignment = bytes >= kHugePage ? kHugePage : kCacheLine;
  const std::size_t size = (bytes + alignment - 1) / alignment * alignment;
  Block block;
  block.memory_ = {static_cast<std::byte*>(std::aligned_alloc(alignment, size)), Free{size}};
  if (size > 0 && block.memory_ == nullptr) throw std::bad_alloc();
  return block;
}

Block Block::of(std::size_t bytes) {
  Block block = without_huge_pages(bytes);
  ask_for_huge_pages(block.memory_.get(), bytes);
  return block;
}

void* Block::reserve(std::size_t bytes) {
  if (bytes > capacity()) {
    *this = {};
    *this = without_huge_pages(bytes + bytes / 8);  // base cases differ a little in size
  }
  ask_for_huge_pages(memory_.get(), bytes);
  return memory_.get();
}

void* Block::grow(std::size_t bytes, std::size_t used) {
  if (bytes > capacity()) {
    Block larger = of(bytes + bytes / 2);
    std::memcpy(larger.memory_.get(), memory_.get(), used);
    *this = std::move(larger);
  }
  return memory_.get();
}

void Block::give_back_behind(std::size_t used) {
  for_huge_pages(memory_.get() + used, memory_.get() + capacity(),
                 [](std::byte* first, std::size_t size) { madvise(first, size, MADV_FREE); });
}

Block kept_or_new_block(BlockUse use, std::size_t bytes) {
  {
    KeptBlocks& kept = KeptBlocks::instance();
    const std::lock_guard lock(kept.mutex);
    const auto found = smallest_with(bytes, kept[use]);
    if (found != kept[use].end() && found->capacity() <= bytes + bytes / 8) {
      return take(found, kept[use]);
    }
  }
  return Block::of(bytes);
}

BorrowedBlock::BorrowedBlock(BlockUse use, std::size_t bytes) : use_(use) {
  KeptBlocks& kept = KeptBlocks::instance();
  const std::lock_guard lock(kept.mutex);
  if (kept[use].empty()) return;
  const auto found = smallest_with(bytes, kept[use]);
  block_ = take(found == kept[use].end() ? found - 1 : found, kept[use]);
}

BorrowedBlock::~BorrowedBlock() { keep_block(use_, std::move(block_)); }

void keep_block(BlockUse use, Block block) {
  if (block.capacity() == 0) return;
  KeptBlocks& kept = KeptBlocks::instance();
  const std::lock_guard lock(kept.mutex);
  kept[use].insert(smallest_with(block.capacity(), kept[use]), std::move(block));
}

void release_kept_blocks() {
  KeptBlocks& kept = KeptBlocks::instance();
  const std::lock_guard lock(kept.mutex);
  for (std::vector<Block>& blocks : kept.of_use) blocks.clear();
}

}  // namespace spillway::detail
