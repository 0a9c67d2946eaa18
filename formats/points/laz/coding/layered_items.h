#pragma once
// The items behind POINT14: docs/formats-laz.md.

#include <cstddef>
#include <memory>
#include <span>

#include "formats/points/las/laz_record.h"
#include "formats/points/laz/coding/layer.h"

namespace spillway::formats::laz {

/// The models of an item behind POINT14 in one scanner channel.
class LayeredItem {
 public:
  virtual ~LayeredItem() = default;
  /// Begins the channel's share of a chunk, after the point with this part of the record.
  virtual void reset(const std::byte* first) = 0;
  /// `part` is this part of the last record, and becomes that of the next one. `layers` are those
  /// of the item; where they are empty, `part` stays as it is.
  virtual void decode(std::span<Layer> layers, std::byte* part) = 0;
};

/// Throws Failure for an item that is not layered.
std::unique_ptr<LayeredItem> make_layered_item(const LazItem& item);

}  // namespace spillway::formats::laz
