#include "src/delaunay/kernel_common/insertion_arena.h"

#include <sys/mman.h>

#include <algorithm>
#include <cassert>
#include <cstdlib>
#include <iterator>
#include <mutex>
#include <new>

#include "src/runtime/run_memory.h"

namespace spillway::delaunay {
namespace {

constexpr std::size_t kHugePage = std::size_t{1} << 21;
constexpr std::size_t kFirstChunk = std::size_t{1} << 15;
constexpr std::size_t kStandardChunk = 4 * kHugePage;
constexpr std::size_t kAlignment = alignof(std::max_align_t);

thread_local InsertionArena* current_arena = nullptr;

}  // namespace

struct InsertionArena::Kept {
  std::mutex mutex;
  std::vector<Chunk> chunks;  ///< guarded by `mutex`
};

InsertionArena::InsertionArena() {
  assert(current_arena == nullptr);
  current_arena = this;
}

InsertionArena::~InsertionArena() {
  current_arena = nullptr;
  const auto kept = InsertionArena::kept();
  const std::lock_guard lock(kept->mutex);
  std::move(kept_chunks_.begin(), kept_chunks_.end(), std::back_inserter(kept->chunks));
}

InsertionArena& InsertionArena::current() { return *current_arena; }

void InsertionArena::Free::operator()(std::byte* chunk) const { std::free(chunk); }

auto InsertionArena::kept() -> std::shared_ptr<Kept> { return RunMemory::current().get<Kept>(); }

void InsertionArena::release_kept_memory() {
  const auto kept = InsertionArena::kept();
  const std::lock_guard lock(kept->mutex);
  kept->chunks.clear();
}

/// Chunks that span huge pages ask for them; small base cases stay small.
auto InsertionArena::make_chunk(std::size_t bytes) -> Chunk {
  if (bytes == kStandardChunk) {
    const auto kept = InsertionArena::kept();
    const std::lock_guard lock(kept->mutex);
    if (!kept->chunks.empty()) {
      Chunk chunk = std::move(kept->chunks.back());
      kept->chunks.pop_back();
      return chunk;
    }
  }
  const bool huge = bytes >= kHugePage;
  const std::size_t alignment = huge ? kHugePage : kAlignment;
  const std::size_t size = (bytes + alignment - 1) / alignment * alignment;
  Chunk chunk(static_cast<std::byte*>(std::aligned_alloc(alignment, size)));
  if (chunk == nullptr) throw std::bad_alloc();
  if (huge) madvise(chunk.get(), size, MADV_HUGEPAGE);  // a wish: without it, it is only slower
  return chunk;
}

/// Chunks double up to the standard size; only requests above it get larger ones.
void* InsertionArena::allocate(std::size_t bytes) {
  bytes = (bytes + kAlignment - 1) / kAlignment * kAlignment;
  if (bytes > left_) {
    const std::size_t doubled =
        std::min(kStandardChunk, kFirstChunk << std::min<std::size_t>(own_chunks_.size(), 16));
    left_ = std::max(bytes, doubled);
    auto& chunks = left_ == kStandardChunk ? kept_chunks_ : own_chunks_;
    chunks.push_back(make_chunk(left_));
    next_ = chunks.back().get();
  }
  void* result = next_;
  next_ += bytes;
  left_ -= bytes;
  return result;
}

}  // namespace spillway::delaunay
