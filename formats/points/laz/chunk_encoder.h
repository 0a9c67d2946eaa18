#pragma once
// From records to the bytes of one LAZ chunk: docs/formats-laz.md.

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "formats/points/las/laz_record.h"

namespace spillway::formats {

/// Encodes chunk after chunk, with memory that is used again.
class LazChunkEncoder {
 public:
  /// Pointwise items have version 2 (wave packets 1), layered ones 2 to 4. Throws Failure for others.
  explicit LazChunkEncoder(const LazChunkFormat& format);
  ~LazChunkEncoder();
  LazChunkEncoder(LazChunkEncoder&&) noexcept;
  LazChunkEncoder& operator=(LazChunkEncoder&&) noexcept;

  /// Appends the chunk of these records, which are LAS records one after the other: one at least.
  void encode(std::span<const std::byte> records, std::vector<std::byte>& out);

  /// The same for a chunk whose records come in parts: add() takes some, as often as there are any,
  /// and finish() appends the chunk.
  void add(std::span<const std::byte> records);
  void finish(std::vector<std::byte>& out);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace spillway::formats
