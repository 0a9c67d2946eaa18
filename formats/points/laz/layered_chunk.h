#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "formats/points/laz/chunk_decoder.h"
#include "formats/points/laz/chunk_input.h"
#include "formats/points/laz/coding/point14_layers.h"

namespace spillway::detail::laz {

/// Chunks of the compressor 3: the first record as it is, the number of points, the sizes of all
/// layers, the layers. Those after the wanted ones are skipped unseen.
class LayeredChunk {
 public:
  LayeredChunk(const LazChunkFormat& format, bool attributes);

  void begin(LazBytes& bytes, std::uint64_t count);
  void decode(std::span<LatticePoint> points, std::span<PointAttributes> attributes);
  std::size_t end();

 private:
  std::size_t record_length_ = 0;
  std::size_t layer_count_;
  std::size_t wanted_layers_;
  ChunkInput input_;
  std::vector<std::byte> head_;
  std::vector<std::byte> layers_;
  std::uint64_t skipped_ = 0;  // bytes after the wanted layers
  bool at_first_ = true;       // the first record has not been given out
  Point14Layers points_;
};

}  // namespace spillway::detail::laz
