#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <vector>

#include "src/rooms.h"

namespace spillway::runtime {

/// Memory of a run in pieces of one size, each a page of its own, for what comes and goes in pieces
/// of any number. It lies apart from all other memory, so it is not parted by what stays for long:
/// a piece that is let go of fits whoever asks next, and the system can have it as it is. For any
/// thread.
class PagePool {
 public:
  static constexpr std::size_t kPageBytes = 4096;

  struct PutBack {
    PagePool* pool = nullptr;
    void operator()(std::byte* page) const { pool->put_back(page); }
  };
  using Page = std::unique_ptr<std::byte, PutBack>;

  PagePool() = default;
  /// Nobody has a page of it.
  ~PagePool();
  PagePool(const PagePool&) = delete;
  PagePool& operator=(const PagePool&) = delete;

  /// A page, aligned for any type, that holds anything. Throws std::bad_alloc.
  Page take();

  /// Lets the system have all pages that nobody has.
  void give_back_free();

  /// How many pages nobody has that still take memory.
  [[nodiscard]] std::size_t kept() const;

 private:
  void put_back(std::byte* page);
  void map_more();

  mutable std::mutex mutex_;       ///< guards all others
  std::vector<std::byte*> kept_;   ///< that nobody has, the last one first to be taken
  std::vector<std::byte*> given_;  ///< likewise, but without memory until they are used again
  std::vector<void*> mapped_;      ///< stretches of pages; both lists have room for all these
};

}  // namespace spillway::runtime
