#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "formats/meshes/common/mesh_stream.h"

namespace spillway::formats {

/// The stream numbers of a block's vertices, by their short numbers.
class StreamNumbers {
 public:
  /// Of a block whose `fresh` new vertices are numbered from `first` on; `imported` must outlive
  /// it.
  StreamNumbers(std::uint64_t first, std::size_t fresh, std::span<const std::uint64_t> imported)
      : first_(first), fresh_(fresh), imported_(imported) {}
  StreamNumbers(std::uint64_t first, const MeshStreamBlock& block)
      : StreamNumbers(first, block.vertices.size(), block.imported) {}

  /// Number of vertices of the block.
  [[nodiscard]] std::size_t size() const { return fresh_ + imported_.size(); }

  [[nodiscard]] std::uint64_t operator[](std::size_t short_number) const {
    return short_number < fresh_ ? first_ + short_number : imported_[short_number - fresh_];
  }

 private:
  std::uint64_t first_;
  std::size_t fresh_;
  std::span<const std::uint64_t> imported_;
};

/// The short numbers of a block's vertices, by their stream numbers: its own come first, then those
/// that it imports.
class ShortNumbers {
 public:
  /// Of a block whose `fresh` new vertices are numbered from `first` on.
  ShortNumbers(std::uint64_t first, std::size_t fresh) : first_(first), fresh_(fresh) {}

  /// Of a vertex that has come. One of an earlier block is imported from now on.
  std::uint32_t of(std::uint64_t vertex) {
    if (vertex >= first_) return static_cast<std::uint32_t>(vertex - first_);
    const auto [known, is_new] =
        short_.try_emplace(vertex, static_cast<std::uint32_t>(fresh_ + imported_.size()));
    if (is_new) imported_.push_back(vertex);
    return known->second;
  }

  std::vector<std::uint64_t> take_imported() { return std::move(imported_); }

 private:
  std::uint64_t first_;
  std::size_t fresh_;
  std::vector<std::uint64_t> imported_;
  std::unordered_map<std::uint64_t, std::uint32_t> short_;
};

}  // namespace spillway::formats
