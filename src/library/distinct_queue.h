#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <unordered_set>
#include <vector>

#include "src/rooms.h"

namespace spillway::library {

/// Numbers in the order in which they were first added. Most stars have a few dozen cells, so that
/// a search through all of them is faster than any index; of more there is one.
template <class Index>
class DistinctQueue {
 public:
  /// Adds the number unless it is there already; tells whether it was not.
  bool add(Index number) {
    if (size_ < kFew) {
      const auto end = few_.begin() + static_cast<std::ptrdiff_t>(size_);
      if (std::find(few_.begin(), end, number) != end) return false;
      few_[size_++] = number;
      return true;
    }
    if (more_.empty()) index_.insert(few_.begin(), few_.end());
    if (!index_.insert(number).second) return false;
    more_.push_back(number);
    ++size_;
    return true;
  }

  [[nodiscard]] std::size_t size() const { return size_; }
  Index operator[](std::size_t i) const { return i < kFew ? few_[i] : more_[i - kFew]; }

 private:
  static constexpr std::size_t kFew = 64;
  std::array<Index, kFew> few_;
  std::vector<Index> more_;
  std::unordered_set<Index> index_;
  std::size_t size_ = 0;
};

}  // namespace spillway::library
