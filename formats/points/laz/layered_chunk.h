#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "formats/points/laz/chunk_decoder.h"
#include "formats/points/laz/chunk_input.h"
#include "formats/points/laz/coding/point14_layers.h"
#include "formats/points/laz/coding/record_layers.h"

namespace spillway::formats::laz {

/// Chunks of the compressor 3: the first record as it is, the number of points, the sizes of all
/// layers, the layers. Those after the wanted ones are skipped unseen.
class LayeredChunk {
 public:
  LayeredChunk(const LazChunkFormat& format, LazDetail detail);

  void begin(LazBytes& bytes, std::uint64_t count);
  void decode(std::span<LatticePoint> points, std::span<LasFlags> attributes);
  void decode_records(std::span<std::byte> records);
  std::size_t end();

 private:
  std::size_t layer_count_;
  std::size_t wanted_layers_;
  ChunkInput input_;
  std::vector<std::byte> head_;
  std::vector<std::byte> layers_;
  std::vector<std::size_t> sizes_;  // of the wanted layers
  std::uint64_t skipped_ = 0;       // bytes after the wanted layers
  bool at_first_ = true;            // the first record has not been given out
  Point14Layers points_;
  std::optional<RecordLayers> others_;  // where whole records are wanted
  std::vector<std::byte> record_;       // the first one; with others_, the last one
};

}  // namespace spillway::formats::laz
