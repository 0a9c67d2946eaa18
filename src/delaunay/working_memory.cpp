#include "src/delaunay/working_memory.h"

#include <sys/mman.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <new>
#include <utility>
#include <vector>

namespace spillway {
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

}  // namespace

void ask_for_huge_pages(void* memory, std::size_t bytes) {
  auto* const begin = static_cast<std::byte*>(memory);
  for_huge_pages(begin, begin + bytes,
                 [](std::byte* first, std::size_t size) { madvise(first, size, MADV_HUGEPAGE); });
}

void Block::Free::operator()(std::byte* memory) const { std::free(memory); }

void* Block::reserve(std::size_t bytes) {
  if (bytes > capacity_) {
    memory_.reset();
    capacity_ = 0;
    const std::size_t wanted = bytes + bytes / 8;  // base cases differ a little in size
    const bool huge = wanted >= kHugePage;
    const std::size_t alignment = huge ? kHugePage : kCacheLine;
    const std::size_t size = (wanted + alignment - 1) / alignment * alignment;
    memory_.reset(static_cast<std::byte*>(std::aligned_alloc(alignment, size)));
    if (memory_ == nullptr) throw std::bad_alloc();
    capacity_ = size;
    ask_for_huge_pages(memory_.get(), size);
  }
  return memory_.get();
}

void* Block::grow(std::size_t bytes, std::size_t used) {
  if (bytes > capacity_) {
    Block larger;
    larger.reserve(bytes + bytes / 2);
    std::memcpy(larger.memory_.get(), memory_.get(), used);
    *this = std::move(larger);
  }
  return memory_.get();
}

void Block::forget(std::size_t begin, std::size_t end) {
  for_huge_pages(memory_.get() + begin, memory_.get() + end,
                 [](std::byte* first, std::size_t size) { madvise(first, size, MADV_DONTNEED); });
}

struct BorrowedMemory::Kept {
  std::mutex mutex;
  std::vector<std::unique_ptr<WorkingMemory>> free;  ///< guarded by `mutex`
};

auto BorrowedMemory::kept() -> Kept& {
  static Kept kept;
  return kept;
}

BorrowedMemory::BorrowedMemory() {
  {
    const std::lock_guard lock(kept().mutex);
    auto& free = kept().free;
    if (!free.empty()) {
      memory_ = std::move(free.back());
      free.pop_back();
    }
  }
  if (memory_ == nullptr) memory_ = std::make_unique<WorkingMemory>();
}

BorrowedMemory::~BorrowedMemory() {
  const std::lock_guard lock(kept().mutex);
  kept().free.push_back(std::move(memory_));
}

void BorrowedMemory::release_kept_memory() {
  const std::lock_guard lock(kept().mutex);
  kept().free.clear();
}

}  // namespace spillway
