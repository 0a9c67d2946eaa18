#include <algorithm>
#include <array>

#include "formats/points/laz/coding/record_fields.h"
#include "formats/points/laz/coding/return_tables.h"
#include "formats/points/laz/coding/streaming_median.h"
#include "formats/points/laz/encoding/integer_encoder.h"
#include "formats/points/laz/encoding/item_encoder.h"

namespace spillway::formats::laz {
namespace {

class Point10Encoder final : public ItemEncoder {
 public:
  void reset(const std::byte* /*first*/) override {
    changed_.reset();
    returns_.reset();
    classification_.reset();
    user_.reset();
    angle_.reset();
    intensity_.reset();
    source_.reset();
    dx_.reset();
    dy_.reset();
    z_.reset();
    dx_median_.fill({});
    dy_median_.fill({});
    last_intensity_.fill(0);
    last_z_.fill(0);
  }

  void encode(ArithmeticEncoder& stream, const std::byte* part, const std::byte* last) override {
    const unsigned number = byte_at(part, kReturns) & 7U;
    const unsigned returns = byte_at(part, kReturns) >> 3U & 7U;
    const unsigned map = kReturnMap8[returns][number];
    encode_attributes(stream, part, last, map);

    const unsigned single = returns == 1 ? 1 : 0;
    const std::uint32_t dx = word_at(part, kX) - word_at(last, kX);
    dx_.encode(stream, dx_median_[map].get(), dx, single);
    dx_median_[map].add(static_cast<std::int32_t>(dx));
    const std::uint32_t dy = word_at(part, kY) - word_at(last, kY);
    dy_.encode(stream, dy_median_[map].get(), dy, single + (std::min(dx_.width(), 20U) & ~1U));
    dy_median_[map].add(static_cast<std::int32_t>(dy));
    const unsigned width = (dx_.width() + dy_.width()) / 2;
    std::uint32_t& last_z = last_z_[return_level(returns, number)];
    const std::uint32_t z = word_at(part, kZ);
    z_.encode(stream, last_z, z, single + (std::min(width, 18U) & ~1U));
    last_z = z;
  }

 private:
  void encode_attributes(ArithmeticEncoder& stream, const std::byte* part, const std::byte* last,
                         unsigned map) {
    const auto differs = [&](std::size_t at) { return part[at] != last[at]; };
    const std::uint16_t intensity = short_at(part, kIntensity);
    std::uint16_t& last_intensity = last_intensity_[map];
    const std::uint16_t source = short_at(part, core10::kSource);
    const std::uint16_t last_source = short_at(last, core10::kSource);
    const unsigned changed =
        (differs(kReturns) ? 32U : 0U) | (intensity != last_intensity ? 16U : 0U) |
        (differs(core10::kClass) ? 8U : 0U) | (differs(core10::kAngle) ? 4U : 0U) |
        (differs(core10::kUser) ? 2U : 0U) | (source != last_source ? 1U : 0U);
    stream.symbol(changed, changed_.at(0));
    if (changed == 0) return;
    if ((changed & 32U) != 0) {
      stream.symbol(byte_at(part, kReturns), returns_.at(byte_at(last, kReturns)));
    }
    if ((changed & 16U) != 0) {
      intensity_.encode(stream, last_intensity, intensity, std::min(map, 3U));
      last_intensity = intensity;
    }
    if ((changed & 8U) != 0) {
      stream.symbol(byte_at(part, core10::kClass),
                    classification_.at(byte_at(last, core10::kClass)));
    }
    if ((changed & 4U) != 0) {
      const unsigned direction = byte_at(part, kReturns) >> 6U & 1U;
      stream.symbol((byte_at(part, core10::kAngle) - byte_at(last, core10::kAngle)) & 0xFFU,
                    angle_.at(direction));
    }
    if ((changed & 2U) != 0) {
      stream.symbol(byte_at(part, core10::kUser), user_.at(byte_at(last, core10::kUser)));
    }
    if ((changed & 1U) != 0) source_.encode(stream, last_source, source, 0);
  }

  SymbolModels<64> changed_{1};
  SymbolModels<256> returns_{256};
  SymbolModels<256> classification_{256};
  SymbolModels<256> user_{256};
  SymbolModels<256> angle_{2};
  IntegerEncoder<16> intensity_{4};
  IntegerEncoder<16> source_{1};
  IntegerEncoder<32> dx_{2};
  IntegerEncoder<32> dy_{22};
  IntegerEncoder<32> z_{20};
  std::array<StreamingMedian, 16> dx_median_{};
  std::array<StreamingMedian, 16> dy_median_{};
  std::array<std::uint16_t, 16> last_intensity_{};
  std::array<std::uint32_t, 8> last_z_{};
};

}  // namespace

std::unique_ptr<ItemEncoder> make_point10_encoder() { return std::make_unique<Point10Encoder>(); }

}  // namespace spillway::formats::laz
