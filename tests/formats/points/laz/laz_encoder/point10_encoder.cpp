#include <algorithm>
#include <array>

#include "tests/formats/points/laz/laz_encoder/contexts.h"
#include "tests/formats/points/laz/laz_encoder/fields.h"
#include "tests/formats/points/laz/laz_encoder/integer_compressor.h"
#include "tests/formats/points/laz/laz_encoder/item_encoder.h"

namespace spillway::detail::testing {
namespace {

/// A bit for each attribute that differs and that versions 1 and 2 number alike.
unsigned changed_attributes(std::string_view part, std::string_view last) {
  unsigned changed = 0;
  if (part[core10::kClass] != last[core10::kClass]) changed |= 8;
  if (part[core10::kAngle] != last[core10::kAngle]) changed |= 4;
  if (part[core10::kUser] != last[core10::kUser]) changed |= 2;
  if (part.substr(core10::kSource, 2) != last.substr(core10::kSource, 2)) changed |= 1;
  return changed;
}

/// What versions 1 and 2 code alike: bytes by the value before, and the point source.
class Attributes {
 public:
  void byte(ArithmeticEncoder& encoder, std::size_t at, std::string_view part,
            std::string_view last) {
    SymbolModels& models = at == kReturns ? flags_ : at == core10::kClass ? classes_ : users_;
    encoder.symbol(byte_at(part, at), models[byte_at(last, at)]);
  }
  void source(ArithmeticEncoder& encoder, std::string_view part, std::string_view last) {
    sources_.encode(encoder, field<std::uint16_t>(last, core10::kSource),
                    field<std::uint16_t>(part, core10::kSource), 0);
  }

 private:
  SymbolModels flags_{256, 256};
  SymbolModels classes_{256, 256};
  SymbolModels users_{256, 256};
  IntegerCompressor sources_{16, 1};
};

class Point10Version1 : public ItemEncoder {
 public:
  void encode(ArithmeticEncoder& encoder, std::string_view part, std::string_view last) override {
    const unsigned k = encode_coordinates(encoder, part, last);
    const auto intensity = field<std::uint16_t>(part, kIntensity);
    const auto last_intensity = field<std::uint16_t>(last, kIntensity);
    const unsigned changed = changed_attributes(part, last) |
                             (intensity != last_intensity ? 32 : 0) |
                             (part[kReturns] != last[kReturns] ? 16 : 0);
    encoder.symbol(changed, changed_);
    if ((changed & 32) != 0) intensities_.encode(encoder, last_intensity, intensity, 0);
    if ((changed & 16) != 0) attributes_.byte(encoder, kReturns, part, last);
    if ((changed & 8) != 0) attributes_.byte(encoder, core10::kClass, part, last);
    if ((changed & 4) != 0) {
      angles_.encode(encoder, byte_at(last, core10::kAngle), byte_at(part, core10::kAngle),
                     k < 3 ? 1 : 0);
    }
    if ((changed & 2) != 0) attributes_.byte(encoder, core10::kUser, part, last);
    if ((changed & 1) != 0) attributes_.source(encoder, part, last);
  }

 private:
  using Differences = std::array<std::int32_t, 3>;

  static std::int32_t median(Differences values) {
    std::sort(values.begin(), values.end());
    return values[1];
  }

  /// Returns the mean size class of x and y.
  unsigned encode_coordinates(ArithmeticEncoder& encoder, std::string_view part,
                              std::string_view last) {
    const auto dx = difference(field<std::int32_t>(part, kX), field<std::int32_t>(last, kX));
    const auto dy = difference(field<std::int32_t>(part, kY), field<std::int32_t>(last, kY));
    x_.encode(encoder, median(last_dx_), dx, 0);
    y_.encode(encoder, median(last_dy_), dy, std::min(x_.k(), 19U));
    const unsigned k = (x_.k() + y_.k()) / 2;
    z_.encode(encoder, field<std::int32_t>(last, kZ), field<std::int32_t>(part, kZ),
              std::min(k, 19U));
    last_dx_[oldest_] = dx;
    last_dy_[oldest_] = dy;
    oldest_ = (oldest_ + 1) % 3;
    return k;
  }

  IntegerCompressor x_{32, 1};
  IntegerCompressor y_{32, 20};
  IntegerCompressor z_{32, 20};
  IntegerCompressor intensities_{16, 1};
  IntegerCompressor angles_{8, 2};
  Attributes attributes_;
  SymbolModel changed_{64};
  Differences last_dx_{};
  Differences last_dy_{};
  std::size_t oldest_ = 0;
};

class Point10Version2 : public ItemEncoder {
 public:
  void encode(ArithmeticEncoder& encoder, std::string_view part, std::string_view last) override {
    const unsigned number = byte_at(part, kReturns) & 7;
    const unsigned count = byte_at(part, kReturns) >> 3 & 7;
    const std::size_t pulse = kReturnMap8[count][number];
    encode_attributes(encoder, part, last, pulse);

    const unsigned single = count == 1 ? 1 : 0;
    const auto dx = difference(field<std::int32_t>(part, kX), field<std::int32_t>(last, kX));
    x_.encode(encoder, x_medians_[pulse].get(), dx, single);
    x_medians_[pulse].add(dx);
    const auto dy = difference(field<std::int32_t>(part, kY), field<std::int32_t>(last, kY));
    y_.encode(encoder, y_medians_[pulse].get(), dy, single + std::min(even(x_.k()), 20U));
    y_medians_[pulse].add(dy);
    const unsigned k = (x_.k() + y_.k()) / 2;
    std::int32_t& last_z = last_z_[return_level(count, number)];
    const auto z = field<std::int32_t>(part, kZ);
    z_.encode(encoder, last_z, z, single + std::min(even(k), 18U));
    last_z = z;
  }

 private:
  void encode_attributes(ArithmeticEncoder& encoder, std::string_view part, std::string_view last,
                         std::size_t pulse) {
    const auto intensity = field<std::uint16_t>(part, kIntensity);
    std::uint16_t& last_intensity = last_intensities_[pulse];
    const unsigned changed = changed_attributes(part, last) |
                             (part[kReturns] != last[kReturns] ? 32 : 0) |
                             (intensity != last_intensity ? 16 : 0);
    encoder.symbol(changed, changed_);
    if ((changed & 32) != 0) attributes_.byte(encoder, kReturns, part, last);
    if ((changed & 16) != 0) {
      intensities_.encode(encoder, last_intensity, intensity, std::min<std::size_t>(pulse, 3));
      last_intensity = intensity;
    }
    if ((changed & 8) != 0) attributes_.byte(encoder, core10::kClass, part, last);
    if ((changed & 4) != 0) {
      const unsigned direction = byte_at(part, kReturns) >> 6 & 1;
      encoder.symbol((byte_at(part, core10::kAngle) - byte_at(last, core10::kAngle)) & 0xff,
                     angles_[direction]);
    }
    if ((changed & 2) != 0) attributes_.byte(encoder, core10::kUser, part, last);
    if ((changed & 1) != 0) attributes_.source(encoder, part, last);
  }

  IntegerCompressor x_{32, 2};
  IntegerCompressor y_{32, 22};
  IntegerCompressor z_{32, 20};
  IntegerCompressor intensities_{16, 4};
  Attributes attributes_;
  SymbolModel changed_{64};
  SymbolModels angles_{2, 256};
  std::array<StreamingMedian, 16> x_medians_;
  std::array<StreamingMedian, 16> y_medians_;
  std::array<std::uint16_t, 16> last_intensities_{};
  std::array<std::int32_t, 8> last_z_{};
};

}  // namespace

std::unique_ptr<ItemEncoder> make_point10_encoder(int version) {
  if (version == 1) return std::make_unique<Point10Version1>();
  return std::make_unique<Point10Version2>();
}

}  // namespace spillway::detail::testing
