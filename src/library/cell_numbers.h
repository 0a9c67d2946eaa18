#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "src/delaunay/common/slab_array.h"
#include "src/delaunay/common/triangulation.h"

namespace spillway::library {

/// The numbers of a triangulation's finite simplices, from 0 in the order of its lists. A bit tells
/// of each slot whether it has one; 64 slots share the number of the first. So all that is looked
/// up takes a quarter of a byte a slot, and stays in the processor's caches.
template <int D>
class CellNumbers {
 public:
  static constexpr std::size_t kSlots = 64;

  /// 64 slots of a list.
  class Chunk {
   public:
    Chunk() = default;
    explicit Chunk(std::uint64_t cells) : cells_(cells) {}

    [[nodiscard]] std::size_t count() const { return std::popcount(cells_); }
    void begin_at(std::size_t number) { first_ = number; }

    /// The number of the cell in this slot, -1 if there is none.
    [[nodiscard]] std::int64_t number(std::size_t slot) const {
      if (cells_ == kAll) return first_ + static_cast<std::int64_t>(slot);
      const std::uint64_t bit = std::uint64_t{1} << slot;
      return (cells_ & bit) == 0 ? -1 : first_ + std::popcount(cells_ & (bit - 1));
    }

   private:
    static constexpr std::uint64_t kAll = ~std::uint64_t{0};

    std::uint64_t cells_ = 0;  // by slot
    std::int64_t first_ = 0;
  };

  /// Made by all threads.
  explicit CellNumbers(const Triangulation<D>& triangulation);

  /// Number of finite simplices.
  [[nodiscard]] std::size_t count() const { return count_; }

  /// The chunks of a list's slots.
  [[nodiscard]] const Chunk* list(std::uint32_t list) const {
    return chunks_.data() + lists_[list];
  }

  /// The number of a cell, given its list's chunks; -1 for infinite and removed simplices.
  static std::int64_t number(const Chunk* list, std::uint32_t index) {
    return list[index / kSlots].number(index % kSlots);
  }

 private:
  std::vector<std::size_t> lists_;  // the first chunk, by list
  SlabArray<Chunk> chunks_;
  std::size_t count_ = 0;
};

}  // namespace spillway::library
