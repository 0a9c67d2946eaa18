#include "formats/points/laz/coding/record_layers.h"

#include <cstring>

namespace spillway::formats::laz {

RecordLayers::RecordLayers(const LazChunkFormat& format)
    : knows_channel_(format.items.front().version >= kKnowsChannel) {
  std::size_t at = 0;
  for (const LazItem& item : format.items) {
    if (at > 0) {
      items_.push_back({at,
                        item.size,
                        {item.version, item.size, [item] { return make_layered_item(item); }},
                        std::vector<Layer>(laz_layers(item))});
    }
    at += item.size;
  }
}

void RecordLayers::begin(const std::byte* first, std::span<const std::byte> layers,
                         std::span<const std::size_t> sizes) {
  layers = fields_.begin(first, layers, sizes.first<Point14OtherLayers::kLayers>());
  sizes = sizes.subspan(Point14OtherLayers::kLayers);
  const unsigned channel = Point14::of_record(first).channel;
  for (Item& item : items_) {
    for (Layer& layer : item.layers) {
      layers = layer.begin(layers, sizes.front());
      sizes = sizes.subspan(1);
    }
    item.contexts.begin(first + item.at, channel);
  }
}

void RecordLayers::decode(const Point14& point, const Point14Changes& changes, std::byte* record) {
  fields_.decode(point, changes, record);
  const unsigned channel = knows_channel_ || changes.channel ? point.channel : 0;
  for (Item& item : items_) {
    const auto [models, last] = item.contexts.go_to(channel);
    models.decode(item.layers, last);
    std::memcpy(record + item.at, last, item.size);
  }
}

void RecordLayers::end() const {
  fields_.end();
  for (const Item& item : items_) {
    for (const Layer& layer : item.layers) layer.end();
  }
}

}  // namespace spillway::formats::laz
