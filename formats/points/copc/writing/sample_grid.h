#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "src/rooms.h"

namespace spillway::formats {

/// Which sample cells of a node have a point.
class SampleGrid {
 public:
  /// 2^bits cells along each axis.
  explicit SampleGrid(unsigned bits) : words_((std::size_t{1} << 3 * bits) / kWord + 1, 0) {}

  /// Whether the cell was free, which it is no longer.
  bool take(std::size_t cell) {
    std::uint64_t& word = words_[cell / kWord];
    const std::uint64_t bit = std::uint64_t{1} << cell % kWord;
    const bool was_free = (word & bit) == 0;
    word |= bit;
    return was_free;
  }

  /// Frees it.
  void free(std::size_t cell) { words_[cell / kWord] &= ~(std::uint64_t{1} << cell % kWord); }

 private:
  static constexpr std::size_t kWord = 64;
  std::vector<std::uint64_t> words_;
};

}  // namespace spillway::formats
