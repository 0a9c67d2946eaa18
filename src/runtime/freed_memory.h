#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>

#include "src/rooms.h"

namespace spillway::runtime {

/// What the allocator keeps of freed memory, for the next who asks. Pages that one stage of a run
/// has used in pieces do not fit what the next one wants, so they would add up. The allocator is of
/// the process: runs beside each other may hold the sum of their limits.
class FreedMemory {
 public:
  /// The process may hold so many bytes more than it did when the first of the runs began that go
  /// on beside each other.
  explicit FreedMemory(std::uint64_t limit);
  ~FreedMemory();
  FreedMemory(const FreedMemory&) = delete;
  FreedMemory& operator=(const FreedMemory&) = delete;

  /// Gives the system all that is free, if the process holds more than it may, or will with so many
  /// bytes more; few are not looked at, as they may well be taken of what is free. Takes about a
  /// microsecond if not; what is given back costs as much a page when it is used again, so it is
  /// done again only when the process has grown by some of the limit. For any thread.
  void give_back(std::uint64_t wanted);

 private:
  const std::uint64_t limit_;
  const std::uint64_t step_;                  ///< bytes
  std::atomic<std::uint64_t> next_most_ = 0;  ///< more, when not that much was free
  std::mutex mutex_;                          ///< held while memory is given back
};

}  // namespace spillway::runtime
