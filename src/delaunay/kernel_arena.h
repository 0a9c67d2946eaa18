#pragma once
// Memory for one base case. CGAL's containers ask for blocks that grow, and give them all back at the
// end; taken from malloc, each base case pays again for fresh pages and for address translation.
// An arena asks the system for huge pages instead and never gives single blocks back. Measured: 10 to
// 15% of a 3D base case (docs/performance.md).

#include <cstddef>
#include <memory>
#include <vector>

namespace spillway {

/// Serves the thread that made it, from its construction to its destruction. One at a time a thread.
class KernelArena {
 public:
  KernelArena();
  ~KernelArena();
  KernelArena(const KernelArena&) = delete;
  KernelArena& operator=(const KernelArena&) = delete;

  /// The calling thread's arena; there must be one.
  static KernelArena& current();

  /// Memory that lasts as long as the arena, aligned for any type. Throws std::bad_alloc.
  void* allocate(std::size_t bytes);

 private:
  struct Free {
    void operator()(std::byte* chunk) const;
  };
  using Chunk = std::unique_ptr<std::byte, Free>;

  static Chunk make_chunk(std::size_t bytes);

  std::vector<Chunk> chunks_;
  std::byte* next_ = nullptr;
  std::size_t left_ = 0;
};

/// An allocator of the standard's form that takes from the calling thread's arena.
template <typename T>
struct KernelAllocator {
  using value_type = T;

  KernelAllocator() = default;
  template <typename U>
  explicit(false) KernelAllocator(const KernelAllocator<U>&) {}

  T* allocate(std::size_t count) {
    return static_cast<T*>(KernelArena::current().allocate(count * sizeof(T)));
  }
  void deallocate(T*, std::size_t) {}

  bool operator==(const KernelAllocator&) const { return true; }
};

}  // namespace spillway
