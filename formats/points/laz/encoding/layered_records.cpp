#include "formats/points/laz/encoding/layered_records.h"

#include <cstring>

#include "formats/points/laz/coding/record_fields.h"
#include "src/error.h"

namespace spillway::formats::laz {
namespace {

std::unique_ptr<ItemEncoder> make_byte_encoder() { return make_bytes_encoder(1); }

/// Appends the layers of an item that begins at `at` in the record.
void add_layers(std::vector<LayerEncoder>& layers, const LazItem& item, std::size_t at) {
  const auto add = [&](std::size_t offset, std::size_t size, LayerEncoder::Make make) {
    layers.emplace_back(item.version, at + offset, size, make);
  };
  switch (item.type) {
    case LazItemType::kRgb14:
      add(0, 6, make_rgb_encoder);
      break;
    case LazItemType::kRgbNir14:
      add(0, 6, make_rgb_encoder);
      add(6, 2, make_nir_encoder);
      break;
    case LazItemType::kWavePacket14:
      add(0, item.size, make_wave_packet_encoder);
      break;
    case LazItemType::kByte14:
      for (std::size_t i = 0; i < item.size; ++i) add(i, 1, make_byte_encoder);
      break;
    default:
      throw Failure("this part of a compressed record is not layered");
  }
}

}  // namespace

void LayerEncoder::reset(const std::byte* first, unsigned channel) {
  layer_.reset();
  contexts_.begin(first + at_, channel);
}

void LayerEncoder::encode(const std::byte* record, unsigned channel) {
  const std::byte* part = record + at_;
  const auto [models, last] = contexts_.go_to(channel);
  layer_.changes |= std::memcmp(part, last, size_) != 0;
  models.encode(layer_.stream, part, last);
  std::memcpy(last, part, size_);
}

LayeredRecords::LayeredRecords(const LazChunkFormat& format)
    : knows_channel_(format.items.front().version >= kKnowsChannel) {
  std::size_t at = 0;
  for (const LazItem& item : format.items) {
    if (at > 0) add_layers(others_, item, at);
    at += item.size;
  }
}

void LayeredRecords::reset(const std::byte* first) {
  points_.reset(first);
  const unsigned channel = byte_at(first, core14::kFlags) >> 4U & 3U;
  for (LayerEncoder& layer : others_) layer.reset(first, channel);
}

void LayeredRecords::encode(const std::byte* record) {
  const ChannelStep step = points_.encode(record);
  const unsigned channel = knows_channel_ || step.switched ? step.channel : 0;
  for (LayerEncoder& layer : others_) layer.encode(record, channel);
}

std::vector<LayerStream*> LayeredRecords::layers() {
  std::vector<LayerStream*> layers;
  for (LayerStream& layer : points_.layers()) layers.push_back(&layer);
  for (LayerEncoder& layer : others_) layers.push_back(&layer.layer());
  return layers;
}

}  // namespace spillway::formats::laz
