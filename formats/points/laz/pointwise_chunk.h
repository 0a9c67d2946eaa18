#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "formats/points/laz/chunk_decoder.h"
#include "formats/points/laz/coding/arithmetic_decoder.h"
#include "formats/points/laz/coding/pointwise_item.h"

namespace spillway::formats::laz {

/// Chunks of the compressors 1 and 2: the first record as it is, then one stream for all others.
class PointwiseChunk {
 public:
  PointwiseChunk(const LazChunkFormat& format, LazDetail detail);

  void begin(LazBytes& bytes, std::uint64_t count);
  void decode(std::span<LatticePoint> points, std::span<LasFlags> attributes);
  void decode_records(std::span<std::byte> records);
  std::size_t end() { return stream_.rest().size(); }

 private:
  struct Item {
    std::unique_ptr<PointwiseItem> models;
    std::size_t at;  // in the record
  };

  std::unique_ptr<Point10Item> point_;
  std::vector<Item> others_;
  std::vector<std::byte> record_;  // the first one; the last one where whole records are wanted
  bool at_first_ = true;           // the first record has not been given out
  ArithmeticDecoder stream_;
};

}  // namespace spillway::formats::laz
