#pragma once

#include <algorithm>
#include <cstddef>
#include <type_traits>
#include <utility>

#include "src/delaunay/common/working_memory.h"

namespace spillway::detail {

/// An array of plain items at the beginning of a block of memory. Items are not initialised.
template <typename T>
requires std::is_trivially_copyable_v<T>
class BlockArray {
 public:
  BlockArray() = default;

  explicit BlockArray(std::size_t size) : BlockArray(Block::of(size * sizeof(T)), size) {}

  /// All items are `value`.
  BlockArray(std::size_t size, const T& value) : BlockArray(size) {
    std::fill(begin(), end(), value);
  }

  /// Takes over a block, which has room for `size` items.
  BlockArray(Block block, std::size_t size) : block_(std::move(block)), size_(size) {}

  BlockArray(BlockArray&& other) noexcept
      : block_(std::move(other.block_)), size_(std::exchange(other.size_, 0)) {}
  BlockArray& operator=(BlockArray&& other) noexcept {
    block_ = std::move(other.block_);
    size_ = std::exchange(other.size_, 0);
    return *this;
  }

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }

  [[nodiscard]] T* data() { return static_cast<T*>(block_.data()); }
  [[nodiscard]] const T* data() const { return static_cast<const T*>(block_.data()); }
  T& operator[](std::size_t i) { return data()[i]; }
  const T& operator[](std::size_t i) const { return data()[i]; }
  [[nodiscard]] T* begin() { return data(); }
  [[nodiscard]] T* end() { return data() + size_; }
  [[nodiscard]] const T* begin() const { return data(); }
  [[nodiscard]] const T* end() const { return data() + size_; }

  /// Lets the system have the huge pages that no item uses when it is short of memory.
  void shrink() { block_.give_back_behind(size_ * sizeof(T)); }

  /// The block; the array is empty then.
  Block take_block() {
    size_ = 0;
    return std::move(block_);
  }

 private:
  Block block_;
  std::size_t size_ = 0;
};

}  // namespace spillway::detail
