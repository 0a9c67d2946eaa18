#include "src/runtime/page_pool.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <new>

namespace spillway::runtime {
namespace {

/// Pages that are asked of the system at a time; they take memory when they are first used.
constexpr std::size_t kMappedPages = 1024;

/// The system may have larger pages: those that lie in a stretch as a whole are given back.
void give_back(std::byte* begin, std::byte* end) {
  static const auto size = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE));
  const auto first = (reinterpret_cast<std::uintptr_t>(begin) + size - 1) / size * size;
  const auto last = reinterpret_cast<std::uintptr_t>(end) / size * size;
  if (first < last)
    ::madvise(begin + (first - reinterpret_cast<std::uintptr_t>(begin)), last - first,
              MADV_DONTNEED);
}

}  // namespace

PagePool::~PagePool() {
  for (void* const stretch : mapped_) ::munmap(stretch, kMappedPages * kPageBytes);
}

PagePool::Page PagePool::take() {
  const std::lock_guard lock(mutex_);
  if (kept_.empty() && given_.empty()) map_more();
  std::vector<std::byte*>& from = kept_.empty() ? given_ : kept_;
  Page page(from.back(), {this});
  from.pop_back();
  return page;
}

void PagePool::put_back(std::byte* page) {
  const std::lock_guard lock(mutex_);
  kept_.push_back(page);
}

/// The caller holds the mutex. What is mapped stays so: it takes no memory once it is given back.
void PagePool::map_more() {
  const std::size_t pages = (mapped_.size() + 1) * kMappedPages;
  mapped_.reserve(mapped_.size() + 1);
  kept_.reserve(pages);
  given_.reserve(pages);
  void* const memory = ::mmap(nullptr, kMappedPages * kPageBytes, PROT_READ | PROT_WRITE,
                              MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw std::bad_alloc();
  mapped_.push_back(memory);
  for (std::size_t p = kMappedPages; p-- > 0;) {
    given_.push_back(static_cast<std::byte*>(memory) + p * kPageBytes);
  }
}

void PagePool::give_back_free() {
  const std::lock_guard lock(mutex_);
  std::ranges::sort(kept_);
  for (auto begin = kept_.begin(); begin != kept_.end();) {
    auto end = begin + 1;
    while (end != kept_.end() && *end == *(end - 1) + kPageBytes) ++end;
    give_back(*begin, *(end - 1) + kPageBytes);
    begin = end;
  }
  given_.insert(given_.end(), kept_.rbegin(), kept_.rend());
  kept_.clear();
}

std::size_t PagePool::kept() const {
  const std::lock_guard lock(mutex_);
  return kept_.size();
}

}  // namespace spillway::runtime
