#include "tests/formats/points/laz/laz_encoder/chunk_encoder.h"

#include <functional>
#include <stdexcept>

#include "tests/formats/point_test_helpers.h"
#include "tests/formats/points/laz/laz_encoder/fields.h"
#include "tests/formats/points/laz/laz_encoder/item_encoder.h"
#include "tests/formats/points/laz/laz_encoder/point14_encoder.h"

namespace spillway::detail::testing {
namespace {

/// One layer behind POINT14: a coder of the record, with four contexts.
class LayerEncoder {
 public:
  using Make = std::function<std::unique_ptr<ItemEncoder>()>;

  LayerEncoder(int version, std::size_t at, std::size_t size, Make make, std::string_view first)
      : version_(version),
        at_(at),
        size_(size),
        make_(std::move(make)),
        own_(core14::channel(first)) {
    contexts_[own_] = {make_(), std::string(first.substr(at, size))};
  }

  /// Versions below 4 predict from the context before a switch, and store the value there, if the
  /// one after it has been used before.
  void encode(std::string_view record, unsigned context) {
    const std::string_view coder = record.substr(at_, size_);
    unsigned source = own_;
    if (context != own_) {
      own_ = context;
      if (contexts_[own_].models == nullptr) {
        contexts_[own_] = {make_(), contexts_[source].last};
        source = own_;
      } else if (version_ == 4) {
        source = own_;
      }
    }
    std::string& last = contexts_[source].last;
    stream_.changes |= coder != last;
    contexts_[own_].models->encode(stream_.encoder, coder, last);
    last = coder;
  }

  LayerStream& stream() { return stream_; }

 private:
  struct Context {
    std::unique_ptr<ItemEncoder> models;
    std::string last;
  };

  int version_;
  std::size_t at_;
  std::size_t size_;
  Make make_;
  unsigned own_;
  std::array<Context, 4> contexts_;
  LayerStream stream_;
};

/// Appends the layers of an item that begins at `at` in the record.
void add_layers(std::vector<LayerEncoder>& layers, const LazItem& item, std::size_t at,
                std::string_view first) {
  const auto add = [&](std::size_t offset, std::size_t size, LayerEncoder::Make make) {
    layers.emplace_back(item.version, at + offset, size, std::move(make), first);
  };
  switch (item.type) {
    case LazItemType::kRgb14:
      add(0, 6, [] { return make_rgb_encoder(2); });
      break;
    case LazItemType::kRgbNir14:
      add(0, 6, [] { return make_rgb_encoder(2); });
      add(6, 2, make_nir_encoder);
      break;
    case LazItemType::kWavePacket14:
      add(0, 29, make_wave_packet_encoder);
      break;
    case LazItemType::kByte14:
      for (std::size_t i = 0; i < item.size; ++i) {
        add(i, 1, [] { return make_bytes_encoder(2, 1); });
      }
      break;
    default:
      throw std::logic_error("this item is not layered");
  }
}

std::string encode_pointwise(const std::vector<LazItem>& items,
                             std::span<const std::string> records) {
  struct ItemCoder {
    std::size_t at;
    std::size_t size;
    std::unique_ptr<ItemEncoder> models;
  };
  std::vector<ItemCoder> coders;
  std::size_t at = 0;
  for (const LazItem& item : items) {
    const std::string_view first = std::string_view(records.front()).substr(at, item.size);
    coders.push_back({at, item.size, make_item_encoder(item, first)});
    at += item.size;
  }
  ArithmeticEncoder encoder;
  for (std::size_t i = 1; i < records.size(); ++i) {
    for (const ItemCoder& coder : coders) {
      coder.models->encode(encoder, std::string_view(records[i]).substr(coder.at, coder.size),
                           std::string_view(records[i - 1]).substr(coder.at, coder.size));
    }
  }
  return records.front() + encoder.finish();
}

std::string encode_layered(const std::vector<LazItem>& items, std::span<const std::string> records,
                           const LazChunkOptions& options) {
  const std::string& first = records.front();
  Point14Encoder points{std::string_view(first).substr(0, core14::kSize)};
  std::vector<LayerEncoder> others;
  std::size_t at = core14::kSize;
  for (const LazItem& item : std::span(items).subspan(1)) {
    add_layers(others, item, at, first);
    at += item.size;
  }
  bool z_changes = false;
  for (const std::string& record : records.subspan(1)) {
    const ChannelStep step = points.encode(std::string_view(record).substr(0, core14::kSize));
    z_changes |= record.substr(kZ, 4) != first.substr(kZ, 4);
    // Versions below 4 know the channel only at the point where it changes.
    const bool knows = items.front().version == 4 || step.switched;
    for (LayerEncoder& layer : others) layer.encode(record, knows ? step.channel : 0);
  }
  if (options.empty_z_layer) points.layers()[Point14Encoder::kZLayer].changes = z_changes;

  std::string sizes;
  std::string bytes;
  const auto append = [&](LayerStream& layer) {
    const std::string stream = layer.finish(options.all_layers);
    sizes += bytes_of(static_cast<std::uint32_t>(stream.size()));
    bytes += stream;
  };
  for (LayerStream& layer : points.layers()) append(layer);
  for (LayerEncoder& layer : others) append(layer.stream());
  return first + bytes_of(static_cast<std::uint32_t>(records.size())) + sizes + bytes;
}

}  // namespace

std::string encode_laz_chunk(const std::vector<LazItem>& items,
                             std::span<const std::string> records, const LazChunkOptions& options) {
  if (items.front().type != LazItemType::kPoint14) return encode_pointwise(items, records);
  return encode_layered(items, records, options);
}

}  // namespace spillway::detail::testing
