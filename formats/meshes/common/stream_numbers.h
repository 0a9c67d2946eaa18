#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

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

}  // namespace spillway::formats
