#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "formats/points/laz/coding/laz_bytes.h"

namespace spillway::formats::laz {

/// Bytes of a chunk as they are needed, from spans of any size.
class ChunkInput {
 public:
  ChunkInput() = default;
  explicit ChunkInput(LazBytes& bytes) : bytes_(&bytes) {}

  /// The next `size` bytes in one span, valid until the next call of anything here: a part of a
  /// span, or `gathered`, which grows only as bytes arrive. An Failure if there are fewer.
  std::span<const std::byte> take(std::size_t size, std::vector<std::byte>& gathered);

  void skip(std::uint64_t size);

  /// What is left of the last span.
  [[nodiscard]] std::span<const std::byte> rest() const { return rest_; }

 private:
  void next_span();

  LazBytes* bytes_ = nullptr;
  std::span<const std::byte> rest_;
};

}  // namespace spillway::formats::laz
