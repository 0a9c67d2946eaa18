#pragma once
// Memory for base cases of the own kernels, kept for those that follow: fresh memory costs about as
// much as a tenth of the triangulation in it.

#include <cstddef>
#include <cstdint>
#include <memory>

#include "src/rooms.h"

namespace spillway::delaunay {

/// Asks for huge pages where the memory spans some: a wish, without it everything is only slower.
void ask_for_huge_pages(void* memory, std::size_t bytes);

/// A slab of memory that only grows. It asks for the huge pages that lie in what it was made for;
/// one that would be used in part would be taken as a whole.
class Slab {
 public:
  /// A slab of this size, aligned for cache lines. Throws std::bad_alloc.
  static Slab of(std::size_t bytes);

  /// Memory for at least `bytes` bytes; what it held before may be lost. Some room is added if it
  /// has to be larger than it was. Throws std::bad_alloc.
  void* reserve(std::size_t bytes);

  /// The same without room to spare, but the first `used` bytes stay what they are.
  void* grow(std::size_t bytes, std::size_t used);

  /// Lets the system have the huge pages after the first `used` bytes when it is short of memory.
  void give_back_behind(std::size_t used);

  /// Gives the system those pages now.
  void release_behind(std::size_t used);

  [[nodiscard]] void* data() const { return memory_.get(); }
  [[nodiscard]] std::size_t capacity() const { return memory_ ? memory_.get_deleter().bytes : 0; }

 private:
  struct Free {
    Free() : Free(0) {}
    explicit Free(std::size_t size) : bytes(size) {}
    void operator()(std::byte* memory) const;
    std::size_t bytes;
  };

  static Slab without_huge_pages(std::size_t bytes);

  std::unique_ptr<std::byte, Free> memory_;
};

/// What base cases keep a slab for, so that the next one gets a slab of fitting size.
enum class SlabUse : std::uint8_t { kPoints, kSimplices };

/// A slab on loan: the smallest that an earlier base case left and that has `bytes` bytes, or else
/// the largest, which is to be made larger, if there is any. Gives it back at the end of its life,
/// for a later one of any thread.
class BorrowedSlab {
 public:
  BorrowedSlab(SlabUse use, std::size_t bytes);
  ~BorrowedSlab();
  BorrowedSlab(const BorrowedSlab&) = delete;
  BorrowedSlab& operator=(const BorrowedSlab&) = delete;

  Slab& operator*() { return slab_; }
  Slab* operator->() { return &slab_; }

 private:
  SlabUse use_;
  Slab slab_;
};

/// A slab of at least this size: the smallest one kept for that use if it is not much larger, or
/// else a new one. Throws std::bad_alloc.
Slab kept_or_new_slab(SlabUse use, std::size_t bytes);

/// Keeps a slab for coming base cases.
void keep_slab(SlabUse use, Slab slab);

/// Gives the system the slabs that are kept for coming base cases: all, or those that are larger.
void release_kept_slabs(std::size_t larger_than = 0);

}  // namespace spillway::delaunay
