#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

namespace spillway::detail {

/// The vertices of a mesh stream that are announced and may still be used: as few as the border, as
/// those that come and go within one block are never entered.
class LiveVertices {
 public:
  /// Begins a block.
  void begin_block() { ++block_; }

  /// Notes that the block uses an earlier vertex. False if that is not announced, finalized, or
  /// imported by the block already.
  bool import(std::uint64_t number) {
    const auto found = last_import_.find(number);
    if (found == last_import_.end() || found->second == block_) return false;
    found->second = block_;
    return true;
  }

  void announce(std::uint64_t number) { last_import_.emplace(number, 0); }
  void finalize(std::uint64_t number) { last_import_.erase(number); }

  [[nodiscard]] bool contains(std::uint64_t number) const { return last_import_.contains(number); }
  [[nodiscard]] std::size_t size() const { return last_import_.size(); }

 private:
  std::unordered_map<std::uint64_t, std::uint64_t> last_import_;  // by vertex; blocks from 1
  std::uint64_t block_ = 0;
};

}  // namespace spillway::detail
