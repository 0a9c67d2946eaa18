#include "tests/formats/points/laz/laz_encoder/record_items.h"

#include <algorithm>
#include <array>

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

}  // namespace

std::unique_ptr<ItemDecoder> make_pointwise_decoder(const LazItem& item, const std::byte* first) {
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

std::unique_ptr<ItemDecoder> make_layered_time_decoder(const std::byte* first) {
  return std::make_unique<GpsTimeDecoder>(first, true);
}

std::unique_ptr<ItemDecoder> make_rgb_decoder() { return std::make_unique<RgbDecoder>(); }

std::unique_ptr<ItemDecoder> make_nir_decoder() { return std::make_unique<NirDecoder>(); }

std::unique_ptr<ItemDecoder> make_wave_packet_decoder() {
  return std::make_unique<WavePacketDecoder>();
}

std::unique_ptr<ItemDecoder> make_byte_decoder() { return std::make_unique<BytesDecoder>(1); }

}  // namespace spillway::detail::testing
