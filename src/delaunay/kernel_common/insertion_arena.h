#pragma once
// Memory for one base case. CGAL's containers ask for slabs that grow, and give them all back at
// the end. An arena takes huge pages for them, gives nothing back before the end, and then keeps
// the pages for the next base case: fresh memory costs more than the triangulation of a small part
// of it.

#include <cstddef>
#include <memory>
#include <vector>

#include "src/rooms.h"

namespace spillway::delaunay {

/// Serves the thread that made it, from its construction to its destruction. One at a time a
/// thread.
class InsertionArena {
 public:
  InsertionArena();
  ~InsertionArena();
  InsertionArena(const InsertionArena&) = delete;
  InsertionArena& operator=(const InsertionArena&) = delete;

  /// The calling thread's arena; there must be one.
  static InsertionArena& current();

  /// Memory that lasts as long as the arena, aligned for any type. Throws std::bad_alloc.
  void* allocate(std::size_t bytes);

  /// Gives the system all that is kept for coming base cases of the run.
  static void release_kept_memory();

 private:
  struct Free {
    void operator()(std::byte* chunk) const;
  };
  using Chunk = std::unique_ptr<std::byte, Free>;
  struct Kept;

  static Chunk make_chunk(std::size_t bytes);
  static std::shared_ptr<Kept> kept();

  std::vector<Chunk> own_chunks_;   ///< of other sizes than the standard one
  std::vector<Chunk> kept_chunks_;  ///< of the standard size, to be kept
  std::byte* next_ = nullptr;
  std::size_t left_ = 0;
};

/// An allocator of the standard's form that takes from the calling thread's arena.
template <typename T>
struct InsertionAllocator {
  using value_type = T;

  InsertionAllocator() = default;
  template <typename U>
  explicit(false) InsertionAllocator(const InsertionAllocator<U>&) {}

  T* allocate(std::size_t count) {
    return static_cast<T*>(InsertionArena::current().allocate(count * sizeof(T)));
  }
  void deallocate(T*, std::size_t) {}

  bool operator==(const InsertionAllocator&) const { return true; }
};

}  // namespace spillway::delaunay
