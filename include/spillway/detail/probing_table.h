#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace spillway::detail {

/// Multiplies the bits of a key all over the word; what is taken is its upper part.
inline std::uint64_t scatter(std::uint64_t key) {
  key = (key ^ (key >> 32)) * 0x9e3779b97f4a7c15U;
  return (key ^ (key >> 29)) * 0xbf58476d1ce4e5b9U;
}

/// A set of small entries with open addressing and linear probing: no allocation per entry, and
/// erasing leaves no marks behind, so it never has to be cleaned. An Entry is empty when default
/// constructed, and has empty(), scattered() (its key's bits, scattered) and same_key(other).
template <typename Entry>
class ProbingTable {
 public:
  [[nodiscard]] std::size_t size() const { return size_; }

  /// The entry with the same key, or nullptr. Valid until the next insert() or erase().
  [[nodiscard]] const Entry* find(const Entry& key) const {
    std::size_t i = home(key);
    while (!entries_[i].empty()) {
      if (entries_[i].same_key(key)) return &entries_[i];
      i = after(i);
    }
    return nullptr;
  }
  [[nodiscard]] Entry* find(const Entry& key) {
    return const_cast<Entry*>(std::as_const(*this).find(key));
  }

  /// Adds an entry whose key is not there yet.
  void insert(const Entry& entry) {
    if ((size_ + 1) * 8 > entries_.size() * 5) grow();
    place(entry);
    ++size_;
  }

  /// Removes an entry that find() gave, and closes the gap.
  void erase(Entry* entry) {
    auto gap = static_cast<std::size_t>(entry - entries_.data());
    for (std::size_t i = after(gap); !entries_[i].empty(); i = after(i)) {
      const std::size_t way_from_home = (i - home(entries_[i])) & (entries_.size() - 1);
      if (way_from_home < ((i - gap) & (entries_.size() - 1))) continue;
      entries_[gap] = entries_[i];
      gap = i;
    }
    entries_[gap] = Entry{};
    --size_;
  }

  /// Calls f(entry) for each, in no particular order.
  template <typename F>
  void for_each(F&& f) const {
    for (const Entry& entry : entries_) {
      if (!entry.empty()) f(entry);
    }
  }

 private:
  static constexpr std::size_t kLeast = 64;

  [[nodiscard]] std::size_t home(const Entry& entry) const { return entry.scattered() >> shift_; }
  [[nodiscard]] std::size_t after(std::size_t i) const { return (i + 1) & (entries_.size() - 1); }

  void place(const Entry& entry) {
    std::size_t i = home(entry);
    while (!entries_[i].empty()) i = after(i);
    entries_[i] = entry;
  }

  void grow() {
    std::vector<Entry> old(entries_.size() * 2);
    std::swap(entries_, old);
    --shift_;
    for (const Entry& entry : old) {
      if (!entry.empty()) place(entry);
    }
  }

  std::vector<Entry> entries_ = std::vector<Entry>(kLeast);  // a power of two of them
  int shift_ = 64 - std::countr_zero(kLeast);
  std::size_t size_ = 0;
};

}  // namespace spillway::detail
