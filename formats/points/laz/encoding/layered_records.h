#pragma once
// The layers of chunks of compressor 3: POINT14, and whatever follows it in a record.

#include <cstddef>
#include <memory>
#include <vector>

#include "formats/points/las/laz_record.h"
#include "formats/points/laz/coding/channel_contexts.h"
#include "formats/points/laz/encoding/item_encoder.h"
#include "formats/points/laz/encoding/layer_stream.h"
#include "formats/points/laz/encoding/point14_encoder.h"

namespace spillway::formats::laz {

/// One layer behind POINT14: a part of the record, with a context for each scanner channel.
class LayerEncoder {
 public:
  using Make = std::unique_ptr<ItemEncoder> (*)();

  /// Of the bytes of a record from `at` on.
  LayerEncoder(int version, std::size_t at, std::size_t size, Make make)
      : at_(at), size_(size), contexts_(version, size, make) {}

  void reset(const std::byte* first, unsigned channel);
  void encode(const std::byte* record, unsigned channel);

  [[nodiscard]] LayerStream& layer() { return layer_; }

 private:
  std::size_t at_;
  std::size_t size_;
  ChannelContexts<ItemEncoder> contexts_;
  LayerStream layer_;
};

/// Encodes the records of one chunk after the other, in the item versions 2 to 4.
class LayeredRecords {
 public:
  explicit LayeredRecords(const LazChunkFormat& format);

  /// Begins a chunk with its first record.
  void reset(const std::byte* first);
  void encode(const std::byte* record);

  /// All layers, in the order of the file.
  [[nodiscard]] std::vector<LayerStream*> layers();

 private:
  bool knows_channel_;  // at every point, not only where it changes
  Point14Encoder points_;
  std::vector<LayerEncoder> others_;
};

}  // namespace spillway::formats::laz
