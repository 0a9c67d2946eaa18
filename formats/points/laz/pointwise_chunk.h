#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "formats/points/laz/chunk_decoder.h"
#include "formats/points/laz/coding/arithmetic_decoder.h"
#include "formats/points/laz/coding/pointwise_item.h"

namespace spillway::detail::laz {

/// Chunks of the compressors 1 and 2: the first record as it is, then one stream for all others.
class PointwiseChunk {
 public:
  explicit PointwiseChunk(const LazChunkFormat& format);

  void begin(LazBytes& bytes, std::uint64_t count);
  void decode(std::span<LatticePoint> points, std::span<PointAttributes> attributes);
  std::size_t end() { return stream_.rest().size(); }

 private:
  std::unique_ptr<Point10Item> point_;
  std::vector<std::unique_ptr<PointwiseItem>> others_;
  std::size_t record_length_ = 0;
  std::vector<std::byte> first_record_;
  bool at_first_ = true;  // the first record has not been given out
  ArithmeticDecoder stream_;
};

}  // namespace spillway::detail::laz
