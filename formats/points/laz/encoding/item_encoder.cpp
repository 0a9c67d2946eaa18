#include "formats/points/laz/encoding/item_encoder.h"

#include "formats/points/laz/coding/record_fields.h"
#include "formats/points/laz/encoding/integer_encoder.h"
#include "src/error.h"

namespace spillway::formats::laz {
namespace {

class WavePacketEncoder final : public ItemEncoder {
 public:
  void reset(const std::byte* /*first*/) override {
    index_.reset();
    kinds_.reset();
    offset_.reset();
    size_.reset();
    return_point_.reset();
    direction_.reset();
    last_step_ = 0;
    last_kind_ = 0;
  }

  void encode(ArithmeticEncoder& stream, const std::byte* part, const std::byte* last) override {
    stream.symbol(byte_at(part, wave_packet::kIndex), index_.at(0));
    encode_offset(stream, part, last);
    size_.encode(stream, word_at(last, wave_packet::kSize), word_at(part, wave_packet::kSize), 0);
    return_point_.encode(stream, word_at(last, wave_packet::kReturnPoint),
                         word_at(part, wave_packet::kReturnPoint), 0);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t at = wave_packet::kDirection + 4 * axis;
      direction_.encode(stream, word_at(last, at), word_at(part, at), axis);
    }
  }

 private:
  enum Kind : unsigned { kSame, kNextPacket, kStep, kAny };

  void encode_offset(ArithmeticEncoder& stream, const std::byte* part, const std::byte* last) {
    const auto offset = load<std::uint64_t>(part + wave_packet::kOffset);
    const auto last_offset = load<std::uint64_t>(last + wave_packet::kOffset);
    const std::int64_t step = difference64(offset, last_offset);
    const unsigned kind = step == 0                                                   ? kSame
                          : offset == last_offset + word_at(last, wave_packet::kSize) ? kNextPacket
                          : fits_32_bits(step)                                        ? kStep
                                                                                      : kAny;
    stream.symbol(kind, kinds_.at(last_kind_));
    last_kind_ = kind;
    if (kind == kStep) {
      const auto step32 = static_cast<std::uint32_t>(step);
      offset_.encode(stream, last_step_, step32, 0);
      last_step_ = step32;
    } else if (kind == kAny) {
      stream.raw64(offset);
    }
  }

  SymbolModels<256> index_{1};
  SymbolModels<4> kinds_{4};
  IntegerEncoder<32> offset_{1};
  IntegerEncoder<32> size_{1};
  IntegerEncoder<32> return_point_{1};
  IntegerEncoder<32> direction_{3};
  std::uint32_t last_step_ = 0;
  unsigned last_kind_ = 0;
};

class BytesEncoder final : public ItemEncoder {
 public:
  explicit BytesEncoder(std::size_t bytes) : bytes_(bytes), differences_(bytes) {}

  void reset(const std::byte* /*first*/) override { differences_.reset(); }

  void encode(ArithmeticEncoder& stream, const std::byte* part, const std::byte* last) override {
    for (std::size_t i = 0; i < bytes_; ++i) {
      stream.symbol((byte_at(part, i) - byte_at(last, i)) & 0xFFU, differences_.at(i));
    }
  }

 private:
  std::size_t bytes_;
  SymbolModels<256> differences_;
};

}  // namespace

std::unique_ptr<ItemEncoder> make_wave_packet_encoder() {
  return std::make_unique<WavePacketEncoder>();
}

std::unique_ptr<ItemEncoder> make_bytes_encoder(std::size_t bytes) {
  return std::make_unique<BytesEncoder>(bytes);
}

std::unique_ptr<ItemEncoder> make_item_encoder(const LazItem& item) {
  if (item.version != (item.type == LazItemType::kWavePacket13 ? 1 : 2)) {
    throw Failure("this version of a compressed item is not written");
  }
  switch (item.type) {
    case LazItemType::kPoint10:
      return make_point10_encoder();
    case LazItemType::kGpsTime11:
      return make_gps_time_encoder();
    case LazItemType::kRgb12:
      return make_rgb_encoder();
    case LazItemType::kWavePacket13:
      return make_wave_packet_encoder();
    case LazItemType::kByte:
      return make_bytes_encoder(item.size);
    default:
      throw Failure("this part of a compressed record is not pointwise");
  }
}

}  // namespace spillway::formats::laz
