#include "tests/formats/points/laz/laz_encoder/record_decoder.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
#include <memory>
#include <optional>

#include "formats/bytes/bytes.h"
#include "formats/points/laz/coding/integer_decoder.h"
#include "formats/points/laz/coding/return_tables.h"
#include "formats/points/laz/coding/streaming_median.h"
#include "formats/points/laz/encoding/record_fields.h"
#include "src/error.h"

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
namespace core10 = laz::core10;
namespace core14 = laz::core14;

/// A part of the record.
class ItemDecoder {
 public:
  virtual ~ItemDecoder() = default;
  /// `part` is that of the last record, and becomes that of the next one.
  virtual void decode(ArithmeticDecoder& stream, std::byte* part) = 0;
};

void put_byte(std::byte* part, std::size_t at, unsigned value) {
  part[at] = static_cast<std::byte>(value & 0xFFU);
}

void put_short(std::byte* part, std::size_t at, std::uint32_t value) {
  store(part + at, static_cast<std::uint16_t>(value));
}

class Point10Decoder : public ItemDecoder {
 public:
  void decode(ArithmeticDecoder& stream, std::byte* part) override {
    const unsigned changed = stream.symbol(changed_.at(0));
    const auto byte = [&](SymbolModels<256>& models, std::size_t at) {
      put_byte(part, at, stream.symbol(models.at(byte_at(part, at))));
    };
    if ((changed & 32U) != 0) byte(returns_, kReturns);
    const unsigned number = byte_at(part, kReturns) & 7U;
    const unsigned count = byte_at(part, kReturns) >> 3U & 7U;
    const unsigned map = laz::kReturnMap8[count][number];
    if ((changed & 16U) != 0) {
      last_intensity_[map] = intensity_.decode(stream, last_intensity_[map], std::min(map, 3U));
    }
    put_short(part, kIntensity, last_intensity_[map]);
    if ((changed & 8U) != 0) byte(classes_, core10::kClass);
    if ((changed & 4U) != 0) {
      const unsigned direction = byte_at(part, kReturns) >> 6U & 1U;
      put_byte(part, core10::kAngle,
               byte_at(part, core10::kAngle) + stream.symbol(angles_.at(direction)));
    }
    if ((changed & 2U) != 0) byte(users_, core10::kUser);
    if ((changed & 1U) != 0) {
      put_short(part, core10::kSource, source_.decode(stream, short_at(part, core10::kSource), 0));
    }
    const unsigned single = count == 1 ? 1 : 0;
    const std::uint32_t dx = dx_.decode(stream, dx_median_[map].get(), single);
    dx_median_[map].add(static_cast<std::int32_t>(dx));
    const unsigned dx_width = dx_.width();
    const std::uint32_t dy =
        dy_.decode(stream, dy_median_[map].get(), single + (dx_width < 20 ? dx_width & ~1U : 20U));
    dy_median_[map].add(static_cast<std::int32_t>(dy));
    const unsigned width = (dx_width + dy_.width()) / 2;
    std::uint32_t& z = last_z_[laz::return_level(count, number)];
    z = z_.decode(stream, z, single + (width < 18 ? width & ~1U : 18U));
    store(part + kX, word_at(part, kX) + dx);
    store(part + kY, word_at(part, kY) + dy);
    store(part + kZ, z);
  }

 private:
  SymbolModels<64> changed_{1};
  SymbolModels<256> returns_{256};
  SymbolModels<256> classes_{256};
  SymbolModels<256> users_{256};
  SymbolModels<256> angles_{2};
  IntegerDecoder<16> intensity_{4};
  IntegerDecoder<16> source_{1};
  IntegerDecoder<32> dx_{2};
  IntegerDecoder<32> dy_{22};
  IntegerDecoder<32> z_{20};
  std::array<StreamingMedian, 16> dx_median_{};
  std::array<StreamingMedian, 16> dy_median_{};
  std::array<std::uint32_t, 16> last_intensity_{};
  std::array<std::uint32_t, 8> last_z_{};
};

/// Item version 2, and, `layered`, the layer of POINT14, whose symbols leave out "unchanged".
class GpsTimeDecoder : public ItemDecoder {
 public:
  GpsTimeDecoder(const std::byte* first, bool layered) : layered_(layered) {
    times_[0] = load<std::uint64_t>(first);
  }

  void decode(ArithmeticDecoder& stream, std::byte* part) override {
    while (!decode_in_sequence(stream)) {
    }
    store(part, times_[current_]);
  }

 private:
  /// False if another sequence goes on.
  bool decode_in_sequence(ArithmeticDecoder& stream) {
    std::int32_t& step = steps_[current_];
    if (step == 0) {
      const unsigned kind =
          layered_ ? stream.symbol(without_step_.at(0, 5)) + 1 : stream.symbol(without_step_.at(0));
      if (kind > 2) {
        current_ = (current_ + kind - 2) & 3U;
        return false;
      }
      if (kind == 1) {
        step = static_cast<std::int32_t>(values_.decode(stream, 0, 0));
        extremes_[current_] = 0;
        times_[current_] += static_cast<std::uint64_t>(std::int64_t{step});
      }
      if (kind == 2) begin_sequence(stream);
      return true;
    }
    unsigned symbol =
        layered_ ? stream.symbol(with_step_.at(0, 515)) : stream.symbol(with_step_.at(0));
    if (layered_ && symbol > 510) ++symbol;
    if (symbol > 512) {
      current_ = (current_ + symbol - 512) & 3U;
      return false;
    }
    if (symbol == 512) begin_sequence(stream);
    if (symbol < 511) add_multiple(stream, symbol <= 500 ? int(symbol) : 500 - int(symbol));
    return true;
  }

  void add_multiple(ArithmeticDecoder& stream, int multiple) {
    std::int32_t& step = steps_[current_];
    const std::size_t context = multiple == 1     ? 1
                                : multiple == 0   ? 7
                                : multiple == 500 ? 4
                                : multiple == -10 ? 6
                                : multiple < 0    ? 5
                                : multiple < 10   ? 2
                                                  : 3;
    const std::uint32_t predicted =
        static_cast<std::uint32_t>(multiple) * static_cast<std::uint32_t>(step);
    const auto difference = static_cast<std::int32_t>(values_.decode(stream, predicted, context));
    times_[current_] += static_cast<std::uint64_t>(std::int64_t{difference});
    if (multiple == 1) extremes_[current_] = 0;
    if (multiple != 0 && multiple != 500 && multiple != -10) return;
    if (++extremes_[current_] > 3) {
      step = difference;
      extremes_[current_] = 0;
    }
  }

  void begin_sequence(ArithmeticDecoder& stream) {
    const std::uint64_t high =
        values_.decode(stream, static_cast<std::uint32_t>(times_[current_] >> 32U), 8);
    newest_ = (newest_ + 1) & 3U;
    current_ = newest_;
    times_[current_] = high << 32U | stream.raw(32);
    steps_[current_] = 0;
    extremes_[current_] = 0;
  }

  bool layered_;
  SymbolModels<516> with_step_{1};
  SymbolModels<6> without_step_{1};
  IntegerDecoder<32> values_{9};
  std::array<std::uint64_t, 4> times_{};
  std::array<std::int32_t, 4> steps_{};
  std::array<int, 4> extremes_{};
  unsigned current_ = 0;
  unsigned newest_ = 0;
};

class RgbDecoder : public ItemDecoder {
 public:
  void decode(ArithmeticDecoder& stream, std::byte* part) override {
    const std::array<int, 6> last = {int(byte_at(part, 0)), int(byte_at(part, 1)),
                                     int(byte_at(part, 2)), int(byte_at(part, 3)),
                                     int(byte_at(part, 4)), int(byte_at(part, 5))};
    const unsigned used = stream.symbol(used_.at(0));
    const auto take = [&](std::size_t at, int predicted) {
      if ((used >> at & 1U) == 0) return;
      const auto clamped = static_cast<unsigned>(std::clamp(predicted, 0, 255));
      put_byte(part, at, clamped + stream.symbol(differences_.at(at)));
    };
    take(0, last[0]);
    take(1, last[1]);
    if ((used & 64U) == 0) {
      put_short(part, 2, short_at(part, 0));
      put_short(part, 4, short_at(part, 0));
      return;
    }
    for (std::size_t at = 0; at < 2; ++at) {
      const int red = int(byte_at(part, at)) - last[at];
      take(at + 2, red + last[at + 2]);
      const int green = int(byte_at(part, at + 2)) - last[at + 2];
      take(at + 4, (red + green) / 2 + last[at + 4]);
    }
  }

 private:
  SymbolModels<128> used_{1};
  SymbolModels<256> differences_{6};
};

class NirDecoder : public ItemDecoder {
 public:
  void decode(ArithmeticDecoder& stream, std::byte* part) override {
    const unsigned used = stream.symbol(used_.at(0));
    for (std::size_t i = 0; i < 2; ++i) {
      if ((used >> i & 1U) == 0) continue;
      put_byte(part, i, byte_at(part, i) + stream.symbol(differences_.at(i)));
    }
  }

 private:
  SymbolModels<4> used_{1};
  SymbolModels<256> differences_{2};
};

class WavePacketDecoder : public ItemDecoder {
 public:
  void decode(ArithmeticDecoder& stream, std::byte* part) override {
    put_byte(part, 0, stream.symbol(index_.at(0)));
    kind_ = stream.symbol(kinds_.at(kind_));
    auto offset = load<std::uint64_t>(part + 1);
    if (kind_ == 1) offset += word_at(part, 9);
    if (kind_ == 2) {
      step_ = offsets_.decode(stream, step_, 0);
      offset += static_cast<std::uint64_t>(std::int64_t{static_cast<std::int32_t>(step_)});
    }
    if (kind_ == 3) {
      offset = stream.raw(32);
      offset |= std::uint64_t{stream.raw(32)} << 32U;
    }
    store(part + 1, offset);
    store(part + 9, sizes_.decode(stream, word_at(part, 9), 0));
    store(part + 13, return_points_.decode(stream, word_at(part, 13), 0));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t at = 17 + 4 * axis;
      store(part + at, directions_.decode(stream, word_at(part, at), axis));
    }
  }

 private:
  SymbolModels<256> index_{1};
  SymbolModels<4> kinds_{4};
  IntegerDecoder<32> offsets_{1};
  IntegerDecoder<32> sizes_{1};
  IntegerDecoder<32> return_points_{1};
  IntegerDecoder<32> directions_{3};
  std::uint32_t step_ = 0;
  unsigned kind_ = 0;
};

class BytesDecoder : public ItemDecoder {
 public:
  explicit BytesDecoder(std::size_t bytes) : bytes_(bytes), differences_(bytes) {}
  void decode(ArithmeticDecoder& stream, std::byte* part) override {
    for (std::size_t i = 0; i < bytes_; ++i) {
      put_byte(part, i, byte_at(part, i) + stream.symbol(differences_.at(i)));
    }
  }

 private:
  std::size_t bytes_;
  SymbolModels<256> differences_;
};

std::unique_ptr<ItemDecoder> make_pointwise(const LazItem& item, const std::byte* first) {
  if (item.version != (item.type == LazItemType::kWavePacket13 ? 1 : 2)) {
    throw Error("tests know whole records from item version 2 on");
  }
  switch (item.type) {
    case LazItemType::kPoint10:
      return std::make_unique<Point10Decoder>();
    case LazItemType::kGpsTime11:
      return std::make_unique<GpsTimeDecoder>(first, false);
    case LazItemType::kRgb12:
      return std::make_unique<RgbDecoder>();
    case LazItemType::kWavePacket13:
      return std::make_unique<WavePacketDecoder>();
    default:
      return std::make_unique<BytesDecoder>(item.size);
  }
}

std::vector<std::string> decode_pointwise(const LazChunkFormat& format,
                                          std::span<const std::byte> chunk, std::uint64_t count,
                                          std::size_t length) {
  std::vector<std::byte> record(chunk.begin(), chunk.begin() + length);
  std::vector<std::pair<std::size_t, std::unique_ptr<ItemDecoder>>> items;
  std::size_t at = 0;
  for (const LazItem& item : format.items) {
    items.emplace_back(at, make_pointwise(item, &record[at]));
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
  explicit Channel(const std::byte* point) : times(point + core14::kGpsTime, true) {
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
  GpsTimeDecoder times;
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
    if (layers[8] && time_changed) c.times.decode(*layers[8], point + core14::kGpsTime);
    c.time_changed = time_changed;
  }

  std::array<std::unique_ptr<Channel>, 4> channels_;
  unsigned channel_;
};

/// An item behind POINT14, one part of it for each layer.
class LayeredItem {
 public:
  using Make = std::function<std::unique_ptr<ItemDecoder>()>;
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
        return {{0, std::make_unique<RgbDecoder>}};
      case LazItemType::kRgbNir14:
        return {{0, std::make_unique<RgbDecoder>}, {6, std::make_unique<NirDecoder>}};
      case LazItemType::kWavePacket14:
        return {{0, std::make_unique<WavePacketDecoder>}};
      default: {
        std::vector<Part> bytes;
        for (std::size_t i = 0; i < item_.size; ++i) {
          bytes.push_back({i, [] { return std::make_unique<BytesDecoder>(1); }});
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
