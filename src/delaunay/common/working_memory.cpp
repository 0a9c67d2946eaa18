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

#include "src/runtime/run_memory.h"

namespace spillway::delaunay {
namespace {

constexpr std::size_t kHugePage = std::size_t{1} << 21;
constexpr std::size_t kCacheLine = 64;

/// Calls give(first, bytes) for the huge pages that lie in a stretch of memory, if there are any.
template <typename Give>
void for_huge_pages(std::byte* begin, std::byte* end, const Give& give) {
  const auto misfit = reinterpret_cast<std::uintptr_t>(begin) % kHugePage;
  std::byte* const first = misfit == 0 ? begin : begin + (kHugePage - misfit);
  if (end - first < static_cast<std::ptrdiff_t>(kHugePage)) return;
  give(first, static_cast<std::size_t>(end - first) / kHugePage * kHugePage);
}

struct KeptSlabs {
  std::mutex mutex;
  /// Guarded by `mutex`. The smallest come first.
  std::array<std::vector<Slab>, 2> of_use;

  std::vector<Slab>& operator[](SlabUse use) { return of_use[static_cast<std::size_t>(use)]; }

  /// Those of the run.
  static std::shared_ptr<KeptSlabs> current() { return RunMemory::current().get<KeptSlabs>(); }
};

using SlabIterator = std::vector<Slab>::iterator;

SlabIterator smallest_with(std::size_t bytes, std::vector<Slab>& slabs) {
  return std::lower_bound(
      slabs.begin(), slabs.end(), bytes,
      [](const Slab& slab, std::size_t size) { return slab.capacity() < size; });
}

Slab take(SlabIterator chosen, std::vector<Slab>& slabs) {
  Slab slab = std::move(*chosen);
  slabs.erase(chosen);
  return slab;
}

}  // namespace

void ask_for_huge_pages(void* memory, std::size_t bytes) {
  auto* const begin = static_cast<std::byte*>(memory);
  for_huge_pages(begin, begin + bytes,
                 [](std::byte* first, std::size_t size) { madvise(first, size, MADV_HUGEPAGE); });
}

/// Smaller arrays that the memory is used for later are not to take whole huge pages.
void Slab::Free::operator()(std::byte* memory) const {
  for_huge_pages(memory, memory + bytes,
                 [](std::byte* first, std::size_t size) { madvise(first, size, MADV_NOHUGEPAGE); });
  std::free(memory);
}

Slab Slab::without_huge_pages(std::size_t bytes) {
  const std::size_t alignment = bytes >= kHugePage ? kHugePage : kCacheLine;
  const std::size_t size = (bytes + alignment - 1) / alignment * alignment;
  Slab slab;
  slab.memory_ = {static_cast<std::byte*>(std::aligned_alloc(alignment, size)), Free{size}};
  if (size > 0 && slab.memory_ == nullptr) throw std::bad_alloc();
  return slab;
}

Slab Slab::of(std::size_t bytes) {
  Slab slab = without_huge_pages(bytes);
  ask_for_huge_pages(slab.memory_.get(), bytes);
  return slab;
}

void* Slab::reserve(std::size_t bytes) {
  if (bytes > capacity()) {
    *this = {};
    *this = without_huge_pages(bytes + bytes / 8);  // base cases differ a little in size
  }
  ask_for_huge_pages(memory_.get(), bytes);
  return memory_.get();
}

void* Slab::grow(std::size_t bytes, std::size_t used) {
  if (bytes > capacity()) {
    // In stretches, whose old place is given back at once: so the old slab and the new one never
    // take memory for the same.
    constexpr std::size_t kStretch = kHugePage;
    Slab larger = of(bytes);
    for (std::size_t done = 0; done < used; done += kStretch) {
      const std::size_t size = std::min(kStretch, used - done);
      std::memcpy(larger.memory_.get() + done, memory_.get() + done, size);
      for_huge_pages(memory_.get() + done, memory_.get() + done + size,
                     [](std::byte* first, std::size_t s) { madvise(first, s, MADV_DONTNEED); });
    }
    *this = std::move(larger);
  }
  return memory_.get();
}

void Slab::give_back_behind(std::size_t used) {
  for_huge_pages(memory_.get() + used, memory_.get() + capacity(),
                 [](std::byte* first, std::size_t size) { madvise(first, size, MADV_FREE); });
}

void Slab::release_behind(std::size_t used) {
  for_huge_pages(memory_.get() + used, memory_.get() + capacity(),
                 [](std::byte* first, std::size_t size) { madvise(first, size, MADV_DONTNEED); });
}

Slab kept_or_new_slab(SlabUse use, std::size_t bytes) {
  {
    const auto kept = KeptSlabs::current();
    const std::lock_guard lock(kept->mutex);
    std::vector<Slab>& slabs = (*kept)[use];
    const auto found = smallest_with(bytes, slabs);
    if (found != slabs.end() && found->capacity() <= bytes + bytes / 8) {
      return take(found, slabs);
    }
  }
  return Slab::of(bytes);
}

BorrowedSlab::BorrowedSlab(SlabUse use, std::size_t bytes) : use_(use) {
  const auto kept = KeptSlabs::current();
  const std::lock_guard lock(kept->mutex);
  std::vector<Slab>& slabs = (*kept)[use];
  if (slabs.empty()) return;
  const auto found = smallest_with(bytes, slabs);
  slab_ = take(found == slabs.end() ? found - 1 : found, slabs);
}

BorrowedSlab::~BorrowedSlab() { keep_slab(use_, std::move(slab_)); }

void keep_slab(SlabUse use, Slab slab) {
  if (slab.capacity() == 0) return;
  const auto kept = KeptSlabs::current();
  const std::lock_guard lock(kept->mutex);
  std::vector<Slab>& slabs = (*kept)[use];
  slabs.insert(smallest_with(slab.capacity(), slabs), std::move(slab));
}

void release_kept_slabs(std::size_t larger_than) {
  const auto kept = KeptSlabs::current();
  const std::lock_guard lock(kept->mutex);
  for (std::vector<Slab>& slabs : kept->of_use) {
    slabs.erase(smallest_with(larger_than + 1, slabs), slabs.end());
  }
}

}  // namespace spillway::delaunay
