#include "src/delaunay/kernel_arena.h"

#include <sys/mman.h>

#include <algorithm>
#include <cassert>
#include <cstdlib>
#include <new>

namespace spillway {
namespace {

constexpr std::size_t kHugePage = std::size_t{1} << 21;
constexpr std::size_t kFirstChunk = std::size_t{1} << 16;
constexpr std::size_t kLargestChunk = std::size_t{1} << 25;
constexpr std::size_t kAlignment = alignof(std::max_align_t);

thread_local KernelArena* current_arena = nullptr;

}  // namespace

KernelArena::KernelArena() {
  assert(current_arena == nullptr);
  current_arena = this;
}

KernelArena::~KernelArena() { current_arena = nullptr; }

KernelArena& KernelArena::current() { return *current_arena; }

void KernelArena::Free::operator()(std::byte* chunk) const { std::free(chunk); }

/// Chunks that span huge pages ask for them; small base cases stay small.
auto KernelArena::make_chunk(std::size_t bytes) -> Chunk {
  const bool huge = bytes >= kHugePage;
  const std::size_t alignment = huge ? kHugePage : kAlignment;
  const std::size_t size = (bytes + alignment - 1) / alignment * alignment;
  Chunk chunk(static_cast<std::byte*>(std::aligned_alloc(alignment, size)));
  if (chunk == nullptr) throw std::bad_alloc();
  if (huge) madvise(chunk.get(), size, MADV_HUGEPAGE);  // a wish: without it, it is only slower
  return chunk;
}

void* KernelArena::allocate(std::size_t bytes) {
  bytes = (bytes + kAlignment - 1) / kAlignment * kAlignment;
  if (bytes > left_) {
    const std::size_t doubled =
        std::min(kLargestChunk, kFirstChunk << std::min<std::size_t>(chunks_.size(), 16));
    left_ = std::max(bytes, doubled);
    chunks_.push_back(make_chunk(left_));
    next_ = chunks_.back().get();
  }
  void* result = next_;
  next_ += bytes;
  left_ -= bytes;
  return result;
}

}  // namespace spillway
