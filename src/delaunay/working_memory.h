#pragma once
// Memory for one base case of the own kernels, kept for those that follow: fresh memory costs about
// as much as a tenth of the triangulation in it.

#include <cstddef>
#include <memory>

namespace spillway {

/// Asks for huge pages where the memory spans some: a wish, without it everything is only slower.
void ask_for_huge_pages(void* memory, std::size_t bytes);

/// A block of memory that only grows. Blocks that span huge pages ask for them.
class Block {
 public:
  /// Memory for at least so many bytes, aligned for cache lines; what it held before may be lost.
  /// Throws std::bad_alloc.
  void* reserve(std::size_t bytes);

  /// The same, but the first `used` bytes stay what they are. Some room is added for the next time.
  void* grow(std::size_t bytes, std::size_t used);

  /// Gives the system the huge pages that lie between these two bytes; what they held is lost, and
  /// they come back empty when they are used again.
  void forget(std::size_t begin, std::size_t end);

  [[nodiscard]] std::size_t capacity() const { return capacity_; }

 private:
  struct Free {
    void operator()(std::byte* memory) const;
  };
  std::unique_ptr<std::byte, Free> memory_;
  std::size_t capacity_ = 0;
};

/// What one base case works in.
struct WorkingMemory {
  Block points;
  Block simplices;
};

/// Working memory on loan: that of an earlier base case if there is any. Gives it back at the end
/// of its life, for a later one of any thread.
class BorrowedMemory {
 public:
  BorrowedMemory();
  ~BorrowedMemory();
  BorrowedMemory(const BorrowedMemory&) = delete;
  BorrowedMemory& operator=(const BorrowedMemory&) = delete;

  WorkingMemory& operator*() { return *memory_; }

  /// Gives the system all that is kept for coming base cases.
  static void release_kept_memory();

 private:
  struct Kept;
  static Kept& kept();

  std::unique_ptr<WorkingMemory> memory_;
};

}  // namespace spillway
