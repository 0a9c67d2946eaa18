#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <type_traits>
#include <utility>

#include "src/delaunay/common/working_memory.h"

namespace spillway::delaunay {

/// An array of plain items at the beginning of a slab of memory. Items are not initialised.
template <typename T>
requires std::is_trivially_copyable_v<T>
class SlabArray {
 public:
  SlabArray() = default;

  explicit SlabArray(std::size_t size) : SlabArray(Slab::of(size * sizeof(T)), size) {}

  /// All items are `value`.
  SlabArray(std::size_t size, const T& value) : SlabArray(size) {
    std::fill(begin(), end(), value);
  }

  /// Takes over a slab, which has room for `size` items.
  SlabArray(Slab slab, std::size_t size) : slab_(std::move(slab)), size_(size) {}

  SlabArray(SlabArray&& other) noexcept
      : slab_(std::move(other.slab_)), size_(std::exchange(other.size_, 0)) {}
  SlabArray& operator=(SlabArray&& other) noexcept {
    slab_ = std::move(other.slab_);
    size_ = std::exchange(other.size_, 0);
    return *this;
  }

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }

  [[nodiscard]] T* data() { return static_cast<T*>(slab_.data()); }
  [[nodiscard]] const T* data() const { return static_cast<const T*>(slab_.data()); }
  T& operator[](std::size_t i) { return data()[i]; }
  const T& operator[](std::size_t i) const { return data()[i]; }
  [[nodiscard]] T* begin() { return data(); }
  [[nodiscard]] T* end() { return data() + size_; }
  [[nodiscard]] const T* begin() const { return data(); }
  [[nodiscard]] const T* end() const { return data() + size_; }

  [[nodiscard]] std::span<const T> span() const { return {data(), size_}; }

  /// Lets the system have the huge pages that no item uses when it is short of memory.
  void shrink() { slab_.give_back_behind(size_ * sizeof(T)); }

  /// Gives the system these pages now.
  void release_rest() { slab_.release_behind(size_ * sizeof(T)); }

  /// The slab; the array is empty then.
  Slab take_slab() {
    size_ = 0;
    return std::move(slab_);
  }

 private:
  Slab slab_;
  std::size_t size_ = 0;
};

}  // namespace spillway::delaunay
