#include "tests/formats/points/laz/laz_encoder/item_encoder.h"

#include <stdexcept>

#include "tests/formats/points/laz/laz_encoder/fields.h"
#include "tests/formats/points/laz/laz_encoder/integer_compressor.h"

namespace spillway::detail::testing {
namespace {

class WavePacketEncoder : public ItemEncoder {
 public:
  void encode(ArithmeticEncoder& encoder, std::string_view part, std::string_view last) override {
    constexpr std::size_t kOffset = 1;
    constexpr std::size_t kSize = 9;
    constexpr std::size_t kReturnPoint = 13;
    constexpr std::size_t kDirection = 17;
    encoder.symbol(byte_at(part, 0), index_);

    const auto offset = field<std::uint64_t>(part, kOffset);
    const auto last_offset = field<std::uint64_t>(last, kOffset);
    const std::int64_t step = difference64(offset, last_offset);
    const unsigned context = kind_;
    kind_ = step == 0                                                   ? 0
            : offset == last_offset + field<std::uint32_t>(last, kSize) ? 1
            : fits_32_bits(step)                                        ? 2
                                                                        : 3;
    encoder.symbol(kind_, kinds_[context]);
    if (kind_ == 2) {
      const auto step32 = static_cast<std::int32_t>(step);
      offsets_.encode(encoder, last_step_, step32, 0);
      last_step_ = step32;
    } else if (kind_ == 3) {
      encoder.raw64(offset);
    }
    const auto code = [&](IntegerCompressor& values, std::size_t at, std::size_t context_of) {
      values.encode(encoder, field<std::int32_t>(last, at), field<std::int32_t>(part, at),
                    context_of);
    };
    code(sizes_, kSize, 0);
    code(return_points_, kReturnPoint, 0);
    for (std::size_t axis = 0; axis < 3; ++axis) code(directions_, kDirection + 4 * axis, axis);
  }

 private:
  SymbolModel index_{256};
  SymbolModels kinds_{4, 4};
  IntegerCompressor offsets_{32, 1};
  IntegerCompressor sizes_{32, 1};
  IntegerCompressor return_points_{32, 1};
  IntegerCompressor directions_{32, 3};
  std::int32_t last_step_ = 0;
  unsigned kind_ = 0;
};

class BytesVersion1 : public ItemEncoder {
 public:
  explicit BytesVersion1(std::size_t bytes) : values_(8, bytes) {}
  void encode(ArithmeticEncoder& encoder, std::string_view part, std::string_view last) override {
    for (std::size_t i = 0; i < part.size(); ++i) {
      values_.encode(encoder, byte_at(last, i), byte_at(part, i), i);
    }
  }

 private:
  IntegerCompressor values_;
};

class BytesVersion2 : public ItemEncoder {
 public:
  explicit BytesVersion2(std::size_t bytes) : differences_(bytes, 256) {}
  void encode(ArithmeticEncoder& encoder, std::string_view part, std::string_view last) override {
    for (std::size_t i = 0; i < part.size(); ++i) {
      encoder.symbol((byte_at(part, i) - byte_at(last, i)) & 0xff, differences_[i]);
    }
  }

 private:
  SymbolModels differences_;
};

}  // namespace

std::unique_ptr<ItemEncoder> make_wave_packet_encoder() {
  return std::make_unique<WavePacketEncoder>();
}

std::unique_ptr<ItemEncoder> make_bytes_encoder(int version, std::size_t bytes) {
  if (version == 1) return std::make_unique<BytesVersion1>(bytes);
  return std::make_unique<BytesVersion2>(bytes);
}

std::unique_ptr<ItemEncoder> make_item_encoder(const LazItem& item, std::string_view first) {
  switch (item.type) {
    case LazItemType::kPoint10:
      return make_point10_encoder(item.version);
    case LazItemType::kGpsTime11:
      return make_gps_time_encoder(item.version, first);
    case LazItemType::kRgb12:
      return make_rgb_encoder(item.version);
    case LazItemType::kWavePacket13:
      return make_wave_packet_encoder();
    case LazItemType::kByte:
      return make_bytes_encoder(item.version, item.size);
    default:
      throw std::logic_error("this item is not pointwise");
  }
}

}  // namespace spillway::detail::testing
