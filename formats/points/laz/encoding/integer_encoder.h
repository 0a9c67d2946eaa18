#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "formats/points/laz/encoding/arithmetic_encoder.h"

namespace spillway::formats::laz {

/// Encodes integers of 8, 16 or 32 bits by their difference from a prediction, as IntegerDecoder
/// decodes them.
template <unsigned Bits>
class IntegerEncoder {
  static_assert(Bits == 8 || Bits == 16 || Bits == 32);

 public:
  explicit IntegerEncoder(std::size_t contexts) : widths_(contexts), differences_(Bits + 1) {}

  void reset() {
    widths_.reset();
    differences_.reset();
    zero_or_one_ = BitModel();
  }

  /// The next integer; only the lowest Bits of the prediction and the value count.
  [[gnu::always_inline]] void encode(ArithmeticEncoder& stream, std::uint32_t prediction,
                                     std::uint32_t value, std::size_t context) {
    // From -2^(Bits-1) to 2^(Bits-1) - 1.
    const std::int32_t difference =
        static_cast<std::int32_t>((value - prediction) << kUnused) >> kUnused;
    // Width w has -(2^w - 1) ... -2^(w-1) and 2^(w-1) + 1 ... 2^w; width 0 has 0 and 1.
    const auto bits = static_cast<std::uint32_t>(difference);
    const unsigned width = std::bit_width(difference <= 0 ? 0 - bits : bits - 1);
    width_ = width;
    stream.symbol(width, widths_.at(context));
    if (width == 0) {
      stream.bit(difference == 1, zero_or_one_);
      return;
    }
    if (Bits == 32 && width == 32) [[unlikely]] {
      return;
    }
    const std::uint32_t code = difference > 0 ? bits - 1 : bits + ((1U << width) - 1);
    if (width <= kModelled) {
      stream.symbol(code, differences_.at(width, 1U << width));
      return;
    }
    const unsigned low_bits = width - kModelled;
    stream.symbol(code >> low_bits, differences_.at(width, 1U << kModelled));
    stream.raw(code & ((1U << low_bits) - 1), low_bits);
  }

  /// Bits of the last difference, 0 to Bits: a context for other encoders.
  [[nodiscard]] unsigned width() const { return width_; }

 private:
  static constexpr unsigned kModelled = 8;  // further bits are raw
  static constexpr unsigned kUnused = 32 - Bits;

  SymbolModels<Bits + 1> widths_;  // by context
  SymbolModels<256> differences_;  // by width
  BitModel zero_or_one_;           // of width 0
  unsigned width_ = 0;
};

}  // namespace spillway::formats::laz
