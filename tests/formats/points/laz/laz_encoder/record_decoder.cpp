#include "tests/formats/points/laz/laz_encoder/record_decoder.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <optional>

#include "formats/bytes/bytes.h"
#include "formats/points/laz/coding/integer_decoder.h"
#include "formats/points/laz/coding/return_tables.h"
#include "formats/points/laz/coding/streaming_median.h"
#include "formats/points/laz/encoding/record_fields.h"
#include "src/error.h"
#include "tests/formats/points/laz/laz_encoder/record_items.h"

namespace spillway::detail::testing {
namespace {

using laz::ArithmeticDecoder;
using laz::byte_at;
using laz::IntegerDecoder;
using laz::kIntensity;
using laz::kReturns;
using laz::kX;
using laz::kY;
using laz::kZ;
using laz::short_at;
using laz::StreamingMedian;
using laz::SymbolModels;
using laz::word_at;
namespace core14 = laz::core14;

std::vector<std::string> decode_pointwise(const LazChunkFormat& format,
                                          std::span<const std::byte> chunk, std::uint64_t count,
                                          std::size_t length) {
  std::vector<std::byte> record(chunk.begin(), chunk.begin() + length);
  std::vector<std::pair<std::size_t, std::unique_ptr<ItemDecoder>>> items;
  std::size_t at = 0;
  for (const LazItem& item : format.items) {
    items.emplace_back(at, make_pointwise_decoder(item, &record[at]));
    at += item.size;
  }
  ArithmeticDecoder stream(chunk.subspan(length));
  std::vector<std::string> records = {std::string(as_text(record))};
  while (records.size() < count) {
    for (const auto& [offset, item] : items) item->decode(stream, &record[offset]);
    records.emplace_back(as_text(record));
  }
  if (!stream.rest().empty()) throw Error("the chunk is longer than its records");
  return records;
}

/// A layer of a chunk; without a stream if it is empty.
using Layer = std::optional<ArithmeticDecoder>;

/// The nine layers of POINT14 in one scanner channel.
struct Channel {
  explicit Channel(const std::byte* point)
      : times(make_layered_time_decoder(point + core14::kGpsTime)) {
    std::memcpy(last.data(), point, last.size());
    last_z.fill(word_at(point, kZ));
    last_intensity.fill(short_at(point, kIntensity));
  }

  std::array<std::byte, core14::kSize> last{};
  bool time_changed = false;
  SymbolModels<128> masks{8};
  SymbolModels<3> channels{1};
  SymbolModels<16> counts{16};
  SymbolModels<16> numbers{16};
  SymbolModels<13> steps{1};
  IntegerDecoder<32> dx{2};
  IntegerDecoder<32> dy{22};
  IntegerDecoder<32> z{20};
  SymbolModels<256> classes{64};
  SymbolModels<64> flags{64};
  IntegerDecoder<16> intensities{4};
  IntegerDecoder<16> angles{2};
  SymbolModels<256> users{64};
  IntegerDecoder<16> sources{1};
  std::unique_ptr<ItemDecoder> times;
  std::array<StreamingMedian, 12> dx_median{};
  std::array<StreamingMedian, 12> dy_median{};
  std::array<std::uint32_t, 8> last_z{};
  std::array<std::uint32_t, 8> last_intensity{};
};

class Point14Decoder {
 public:
  explicit Point14Decoder(const std::byte* first)
      : channel_(byte_at(first, core14::kFlags) >> 4U & 3U) {
    channels_[channel_] = std::make_unique<Channel>(first);
  }

  /// Whether the channel changed with the point.
  bool decode(std::span<Layer> layers) {
    ArithmeticDecoder& xy = layers[0].value();
    Channel& before = *channels_[channel_];
    const unsigned before_number = byte_at(before.last.data(), kReturns) & 15U;
    const unsigned before_count = byte_at(before.last.data(), kReturns) >> 4U;
    const unsigned mask = xy.symbol(before.masks.at((before_number == 1 ? 1U : 0U) +
                                                    (before_number >= before_count ? 2U : 0U) +
                                                    (before.time_changed ? 4U : 0U)));
    const bool switched = (mask & 64U) != 0;
    if (switched) {
      channel_ = (channel_ + xy.symbol(before.channels.at(0)) + 1) & 3U;
      if (!channels_[channel_]) channels_[channel_] = std::make_unique<Channel>(before.last.data());
      std::byte& flags = channels_[channel_]->last[core14::kFlags];
      flags = (flags & std::byte{0xCF}) | static_cast<std::byte>(channel_ << 4U);
    }
    decode_in(*channels_[channel_], layers, mask);
    return switched;
  }

  [[nodiscard]] unsigned channel() const { return channel_; }
  [[nodiscard]] const std::byte* point() const { return channels_[channel_]->last.data(); }

 private:
  static void decode_in(Channel& c, std::span<Layer> layers, unsigned mask) {
    ArithmeticDecoder& xy = layers[0].value();
    std::byte* point = c.last.data();
    const bool time_changed = (mask & 16U) != 0;
    unsigned number = byte_at(point, kReturns) & 15U;
    unsigned count = byte_at(point, kReturns) >> 4U;
    if ((mask & 4U) != 0) count = xy.symbol(c.counts.at(count));
    if ((mask & 3U) == 1) number = (number + 1) & 15U;
    if ((mask & 3U) == 2) number = (number + 15) & 15U;
    if ((mask & 3U) == 3) {
      number = time_changed ? xy.symbol(c.numbers.at(number))
                            : (number + xy.symbol(c.steps.at(0)) + 2) & 15U;
    }
    put_byte(point, kReturns, number | count << 4U);
    const unsigned single = count == 1 ? 1 : 0;
    const unsigned place = (number == 1 ? 2U : 0U) + (number >= count ? 1U : 0U);
    const unsigned time = time_changed ? 1 : 0;
    const unsigned median = 2U * laz::kReturnMap16[count][number] + time;
    const std::uint32_t dx = c.dx.decode(xy, c.dx_median[median].get(), single);
    c.dx_median[median].add(static_cast<std::int32_t>(dx));
    const unsigned dx_width = c.dx.width();
    const std::uint32_t dy =
        c.dy.decode(xy, c.dy_median[median].get(), single + (dx_width < 20 ? dx_width & ~1U : 20U));
    c.dy_median[median].add(static_cast<std::int32_t>(dy));
    store(point + kX, word_at(point, kX) + dx);
    store(point + kY, word_at(point, kY) + dy);
    const unsigned width = (dx_width + c.dy.width()) / 2;
    if (layers[1]) {
      std::uint32_t& z = c.last_z[laz::return_level(count, number)];
      z = c.z.decode(*layers[1], z, single + (width < 18 ? width & ~1U : 18U));
      store(point + kZ, z);
    }
    if (layers[2]) {
      const unsigned context = 2 * (byte_at(point, core14::kClass) & 31U) + (place == 3 ? 1U : 0U);
      put_byte(point, core14::kClass, layers[2]->symbol(c.classes.at(context)));
    }
    if (layers[3]) {
      const unsigned before = byte_at(point, core14::kFlags);
      const unsigned six = layers[3]->symbol(c.flags.at((before >> 6U) << 4U | (before & 15U)));
      put_byte(point, core14::kFlags, (before & 0x30U) | (six >> 4U) << 6U | (six & 15U));
    }
    if (layers[4]) {
      std::uint32_t& intensity = c.last_intensity[2 * place + time];
      intensity = c.intensities.decode(*layers[4], intensity, place);
      put_short(point, kIntensity, intensity);
    }
    if (layers[5] && (mask & 8U) != 0) {
      put_short(point, core14::kAngle,
                c.angles.decode(*layers[5], short_at(point, core14::kAngle), time));
    }
    if (layers[6]) {
      const unsigned context = byte_at(point, core14::kUser) / 4;
      put_byte(point, core14::kUser, layers[6]->symbol(c.users.at(context)));
    }
    if (layers[7] && (mask & 32U) != 0) {
      put_short(point, core14::kSource,
                c.sources.decode(*layers[7], short_at(point, core14::kSource), 0));
    }
    if (layers[8] && time_changed) c.times->decode(*layers[8], point + core14::kGpsTime);
    c.time_changed = time_changed;
  }

  std::array<std::unique_ptr<Channel>, 4> channels_;
  unsigned channel_;
};

/// An item behind POINT14, one part of it for each layer.
class LayeredItem {
 public:
  using Make = std::unique_ptr<ItemDecoder> (*)();
  struct Part {
    std::size_t at;  // in the item
    Make make;
  };

  LayeredItem(const LazItem& item, std::size_t at, const std::byte* first, unsigned channel)
      : item_(item), at_(at), own_(channel) {
    begin(own_, first + at_);
  }

  [[nodiscard]] std::vector<Part> parts() const {
    switch (item_.type) {
      case LazItemType::kRgb14:
        return {{0, make_rgb_decoder}};
      case LazItemType::kRgbNir14:
        return {{0, make_rgb_decoder}, {6, make_nir_decoder}};
      case LazItemType::kWavePacket14:
        return {{0, make_wave_packet_decoder}};
      default: {
        std::vector<Part> bytes;
        for (std::size_t i = 0; i < item_.size; ++i) {
          bytes.push_back({i, make_byte_decoder});
        }
        return bytes;
      }
    }
  }

  /// The item of the next record, by the rule of its version about which value is the last one.
  std::string decode(std::span<Layer> layers, unsigned channel) {
    unsigned source = own_;
    if (channel != own_) {
      own_ = channel;
      if (!contexts_[own_]) {
        begin(own_, contexts_[source]->last.data());
        source = own_;
      } else if (item_.version == 4) {
        source = own_;
      }
    }
    std::vector<std::byte>& last = contexts_[source]->last;
    const std::vector<Part> all = parts();
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (layers[i]) contexts_[own_]->models[i]->decode(*layers[i], &last[all[i].at]);
    }
    return std::string(as_text(last));
  }

 private:
  struct Context {
    std::vector<std::unique_ptr<ItemDecoder>> models;
    std::vector<std::byte> last;
  };

  void begin(unsigned channel, const std::byte* last) {
    Context context;
    for (const Part& part : parts()) context.models.push_back(part.make());
    context.last.assign(last, last + item_.size);
    contexts_[channel] = std::move(context);
  }

  LazItem item_;
  std::size_t at_;
  unsigned own_;
  std::array<std::optional<Context>, 4> contexts_;
};

std::vector<std::string> decode_layered(const LazChunkFormat& format,
                                        std::span<const std::byte> chunk, std::uint64_t count,
                                        std::size_t length) {
  const std::span<const std::byte> first = chunk.first(length);
  if (load<std::uint32_t>(&chunk[length]) != count) throw Error("another number of points");
  std::vector<Layer> layers(laz_layers(format));
  std::size_t size_at = length + 4;
  std::size_t at = size_at + 4 * layers.size();
  for (Layer& layer : layers) {
    const std::size_t size = load<std::uint32_t>(&chunk[size_at]);
    if (size > 0) layer.emplace(chunk.subspan(at, size));
    size_at += 4;
    at += size;
  }
  Point14Decoder points(first.data());
  std::vector<LayeredItem> items;
  std::size_t item_at = 0;
  for (const LazItem& item : format.items) {
    if (item_at > 0) items.emplace_back(item, item_at, first.data(), points.channel());
    item_at += item.size;
  }
  std::vector<std::string> records = {std::string(as_text(first))};
  while (records.size() < count) {
    const bool switched = points.decode(layers);
    const unsigned channel = format.items.front().version == 4 || switched ? points.channel() : 0;
    std::string record(as_text({points.point(), core14::kSize}));
    std::size_t layer = 9;
    for (LayeredItem& item : items) {
      const std::size_t parts = item.parts().size();
      record += item.decode(std::span(layers).subspan(layer, parts), channel);
      layer += parts;
    }
    records.push_back(std::move(record));
  }
  for (const Layer& layer : layers) {
    if (layer && !layer->rest().empty()) throw Error("a layer is longer than its records");
  }
  return records;
}

}  // namespace

std::vector<std::string> decode_laz_records(const LazChunkFormat& format,
                                            std::span<const std::byte> chunk, std::uint64_t count) {
  std::size_t length = 0;
  for (const LazItem& item : format.items) length += item.size;
  return format.layered ? decode_layered(format, chunk, count, length)
                        : decode_pointwise(format, chunk, count, length);
}

}  // namespace spillway::detail::testing
