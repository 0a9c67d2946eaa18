#pragma once
// Memory for base cases of the own kernels, kept for those that follow: fresh memory costs about as
// much as a tenth of the triangulation in it.

#include <cstddef>
#include <cstdint>
#include <memory>

namespace spillway::detail {

/// Asks for huge pages where the memory spans some: a wish, without it everything is only slower.
void ask_for_huge_pages(void* memory, std::size_t bytes);

/// A block of memory that only grows. It asks for the huge pages that lie in what it was made for;
/// one that would be used in part would be taken as a whole.
class Block {
 public:
  /// A block of this size, aligned for cache lines. Throws std::bad_alloc.
  static Block of(std::size_t bytes);

  /// Memory for at least `bytes` bytes; what it held before may be lost. Some room is added if it
  /// has to be larger than it was. Throws std::bad_alloc.
  void* reserve(std::size_t bytes);

  /// The same, but the first `used` bytes stay what they are.
  void* grow(std::size_t bytes, std::size_t used);

  /// Lets the system have the huge pages after the first `used` bytes when it is short of memory.
  void give_back_behind(std::size_t used);

  [[nodiscard]] void* data() const { return memory_.get(); }
  [[nodiscard]] std::size_t capacity() const { return memory_ ? memory_.get_deleter().bytes : 0; }

 private:
  struct Free {
    Free() : Free(0) {}
    explicit Free(std::size_t size) : bytes(size) {}
    void operator()(std::byte* memory) const;
    std::size_t bytes;
  };

  static Block without_huge_pages(std::size_t bytes);

  std::unique_ptr<std::byte, Free> memory_;
};

/// What base cases keep a block for, so that the next one gets a block of fitting size.
enum class BlockUse : std::uint8_t { kPoints, kSimplices };

/// A block on loan: the smallest that an earlier base case left and that has `bytes` bytes, or else
/// the largest, which is to be made larger, if there is any. Gives it back at the end of its life,
/// for a later one of any thread.
class BorrowedBlock {
 public:
  BorrowedBlock(BlockUse use, std::size_t bytes);
  ~BorrowedBlock();
  BorrowedBlock(const BorrowedBlock&) = delete;
  BorrowedBlock& operator=(const BorrowedBlock&) = delete;

  Block& operator*() { return block_; }
  Block* operator->() { return &block_; }

 private:
  BlockUse use_;
  Block block_;
};

/// A block of at least this size: the smallest one kept for that use if it is not much larger, or
/// else a new one. Throws std::bad_alloc.
Block kept_or_new_block(BlockUse use, std::size_t bytes);

/// Keeps a block for coming base cases.
void keep_block(BlockUse use, Block block);

/// Gives the system all blocks that are kept for coming base cases.
void release_kept_blocks();

}  // namespace spillway::detail
