#include "src/delaunay/kernel_2d/working_memory.h"

#include <sys/mman.h>

#include <cstdlib>
#include <mutex>
#include <new>
#include <utility>
#include <vector>

namespace spillway::kernel_2d {
namespace {

constexpr std::size_t kHugePage = std::size_t{1} << 21;
constexpr std::size_t kCacheLine = 64;

}  // namespace

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
    if (huge) madvise(memory_.get(), size, MADV_HUGEPAGE);  // a wish: without it, only slower
  }
  return memory_.get();
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

}  // namespace spillway::kernel_2d
