#include "tests/formats/points/laz/laz_encoder/items_v1_encoder.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "formats/points/laz/coding/record_fields.h"
#include "formats/points/laz/encoding/integer_encoder.h"

namespace spillway::test {
namespace {

using laz::ArithmeticEncoder;
using laz::byte_at;
using laz::IntegerEncoder;
using laz::short_at;
using laz::SymbolModels;
using laz::word_at;
namespace core10 = laz::core10;

class Point10Version1 : public laz::ItemEncoder {
 public:
  void reset(const std::byte* /*first*/) override { *this = {}; }

  void encode(ArithmeticEncoder& stream, const std::byte* part, const std::byte* last) override {
    const unsigned width = encode_coordinates(stream, part, last);
    const auto differs = [&](std::size_t at) { return part[at] != last[at]; };
    const std::uint16_t intensity = short_at(part, laz::kIntensity);
    const std::uint16_t last_intensity = short_at(last, laz::kIntensity);
    const std::uint16_t source = short_at(part, core10::kSource);
    const std::uint16_t last_source = short_at(last, core10::kSource);
    const unsigned changed =
        (intensity != last_intensity ? 32U : 0U) | (differs(laz::kReturns) ? 16U : 0U) |
        (differs(core10::kClass) ? 8U : 0U) | (differs(core10::kAngle) ? 4U : 0U) |
        (differs(core10::kUser) ? 2U : 0U) | (source != last_source ? 1U : 0U);
    stream.symbol(changed, changed_.at(0));
    const auto put = [&](SymbolModels<256>& models, std::size_t at) {
      stream.symbol(byte_at(part, at), models.at(byte_at(last, at)));
    };
    if ((changed & 32U) != 0) intensity_.encode(stream, last_intensity, intensity, 0);
    if ((changed & 16U) != 0) put(returns_, laz::kReturns);
    if ((changed & 8U) != 0) put(classes_, core10::kClass);
    if ((changed & 4U) != 0) {
      angle_.encode(stream, byte_at(last, core10::kAngle), byte_at(part, core10::kAngle),
                    width < 3 ? 1 : 0);
    }
    if ((changed & 2U) != 0) put(users_, core10::kUser);
    if ((changed & 1U) != 0) source_.encode(stream, last_source, source, 0);
  }

 private:
  using Differences = std::array<std::int32_t, 3>;

  static std::uint32_t median(Differences values) {
    std::sort(values.begin(), values.end());
    return static_cast<std::uint32_t>(values[1]);
  }

  /// Returns the mean width of x and y.
  unsigned encode_coordinates(ArithmeticEncoder& stream, const std::byte* part,
                              const std::byte* last) {
    const std::uint32_t dx = word_at(part, laz::kX) - word_at(last, laz::kX);
    const std::uint32_t dy = word_at(part, laz::kY) - word_at(last, laz::kY);
    dx_.encode(stream, median(last_dx_), dx, 0);
    dy_.encode(stream, median(last_dy_), dy, std::min(dx_.width(), 19U));
    const unsigned width = (dx_.width() + dy_.width()) / 2;
    z_.encode(stream, word_at(last, laz::kZ), word_at(part, laz::kZ), std::min(width, 19U));
    last_dx_[oldest_] = static_cast<std::int32_t>(dx);
    last_dy_[oldest_] = static_cast<std::int32_t>(dy);
    oldest_ = (oldest_ + 1) % 3;
    return width;
  }

  IntegerEncoder<32> dx_{1};
  IntegerEncoder<32> dy_{20};
  IntegerEncoder<32> z_{20};
  IntegerEncoder<16> intensity_{1};
  IntegerEncoder<8> angle_{2};
  IntegerEncoder<16> source_{1};
  SymbolModels<64> changed_{1};
  SymbolModels<256> returns_{256};
  SymbolModels<256> classes_{256};
  SymbolModels<256> users_{256};
  Differences last_dx_{};
  Differences last_dy_{};
  std::size_t oldest_ = 0;
};

class GpsTimeVersion1 : public laz::ItemEncoder {
 public:
  void reset(const std::byte* /*first*/) override { *this = {}; }

  void encode(ArithmeticEncoder& stream, const std::byte* part, const std::byte* last) override {
    const auto time = load<std::uint64_t>(part);
    const std::int64_t step64 = laz::difference64(time, load<std::uint64_t>(last));
    const bool fits = laz::fits_32_bits(step64);
    const auto step = static_cast<std::int32_t>(step64);
    if (step_ == 0) {
      const unsigned kind = step64 == 0 ? 0 : fits ? 1 : 2;
      stream.symbol(kind, without_step_.at(0));
      if (kind == 2) stream.raw64(time);
      if (kind != 1) return;
      values_.encode(stream, 0, static_cast<std::uint32_t>(step), 0);
      step_ = step;
    } else if (step64 == 0) {
      stream.symbol(511, with_step_.at(0));
    } else if (!fits) {
      stream.symbol(510, with_step_.at(0));
      stream.raw64(time);
    } else {
      encode_multiple(stream, step);
    }
  }

 private:
  void encode_multiple(ArithmeticEncoder& stream, std::int32_t step) {
    const double ratio = std::round(static_cast<double>(step) / step_);
    const auto multiple = static_cast<unsigned>(std::clamp(ratio, 0.0, 509.0));
    stream.symbol(multiple, with_step_.at(0));
    const std::uint32_t predicted = multiple == 0 ? static_cast<std::uint32_t>(step_ / 4)
                                                  : multiple * static_cast<std::uint32_t>(step_);
    const std::size_t context = multiple == 1   ? 1
                                : multiple == 0 ? 2
                                : multiple < 10 ? 3
                                : multiple < 50 ? 4
                                                : 5;
    values_.encode(stream, predicted, static_cast<std::uint32_t>(step), context);
    if (multiple == 0 || multiple == 509) ++extremes_;
    if (multiple == 1 || extremes_ > 3) {
      step_ = step;
      extremes_ = 0;
    }
  }

  SymbolModels<512> with_step_{1};
  SymbolModels<3> without_step_{1};
  IntegerEncoder<32> values_{6};
  std::int32_t step_ = 0;
  int extremes_ = 0;
};

class RgbVersion1 : public laz::ItemEncoder {
 public:
  void reset(const std::byte* /*first*/) override { *this = {}; }

  void encode(ArithmeticEncoder& stream, const std::byte* part, const std::byte* last) override {
    unsigned changed = 0;
    for (std::size_t i = 0; i < 6; ++i) changed |= part[i] != last[i] ? 1U << i : 0;
    stream.symbol(changed, changed_.at(0));
    for (std::size_t i = 0; i < 6; ++i) {
      if ((changed >> i & 1U) == 0) continue;
      values_.encode(stream, byte_at(last, i), byte_at(part, i), i);
    }
  }

 private:
  SymbolModels<64> changed_{1};
  IntegerEncoder<8> values_{6};
};

class BytesVersion1 : public laz::ItemEncoder {
 public:
  explicit BytesVersion1(std::size_t bytes) : bytes_(bytes), values_(bytes) {}

  void reset(const std::byte* /*first*/) override { values_.reset(); }

  void encode(ArithmeticEncoder& stream, const std::byte* part, const std::byte* last) override {
    for (std::size_t i = 0; i < bytes_; ++i) {
      values_.encode(stream, byte_at(last, i), byte_at(part, i), i);
    }
  }

 private:
  std::size_t bytes_;
  IntegerEncoder<8> values_;
};

}  // namespace

std::unique_ptr<laz::ItemEncoder> make_any_item_encoder(const LazItem& item) {
  if (item.version == 1) {
    switch (item.type) {
      case LazItemType::kPoint10:
        return std::make_unique<Point10Version1>();
      case LazItemType::kGpsTime11:
        return std::make_unique<GpsTimeVersion1>();
      case LazItemType::kRgb12:
        return std::make_unique<RgbVersion1>();
      case LazItemType::kByte:
        return std::make_unique<BytesVersion1>(item.size);
      default:
        break;
    }
  }
  return laz::make_item_encoder(item);
}

}  // namespace spillway::test
