#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "formats/points/las/laz_record.h"
#include "formats/points/laz/coding/channel_contexts.h"
#include "formats/points/laz/coding/layered_items.h"
#include "formats/points/laz/coding/point14_layers.h"
#include "formats/points/laz/coding/point14_other_layers.h"

namespace spillway::formats::laz {

/// The layers of a chunk that only whole records need: all after those of Point14Layers.
class RecordLayers {
 public:
  explicit RecordLayers(const LazChunkFormat& format);

  /// Begins a chunk with its first record. `layers` has the bytes of these layers one after the
  /// other, in `sizes`.
  void begin(const std::byte* first, std::span<const std::byte> layers,
             std::span<const std::size_t> sizes);

  /// Puts what these layers hold of the next point into its record. Point14Layers gave the point.
  void decode(const Point14& point, const Point14Changes& changes, std::byte* record);

  /// Checks that all layers have been read to their ends.
  void end() const;

 private:
  struct Item {
    std::size_t at;  // in the record
    std::size_t size;
    ChannelContexts<LayeredItem> contexts;
    std::vector<Layer> layers;
  };

  bool knows_channel_;  // at every point, not only where it changes
  Point14OtherLayers fields_;
  std::vector<Item> items_;
};

}  // namespace spillway::formats::laz
