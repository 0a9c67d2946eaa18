#pragma once

#include <algorithm>
#include <cstdint>

#include "formats/points/laz/coding/arithmetic_decoder.h"
#include "formats/points/laz/coding/models.h"

namespace spillway::formats::laz {

/// Decodes integers of 8, 16 or 32 bits that lie near a prediction: how many bits the difference
/// takes, by a model for each context, then its bits, by models for all contexts.
template <unsigned Bits>
class IntegerDecoder {
  static_assert(Bits == 8 || Bits == 16 || Bits == 32);

 public:
  explicit IntegerDecoder(std::size_t contexts) : widths_(contexts), differences_(Bits + 1) {}

  void reset() {
    widths_.reset();
    differences_.reset();
    zero_or_one_ = BitModel();
  }

  /// The next integer, modulo 2^Bits.
  [[gnu::always_inline]] std::uint32_t decode(ArithmeticDecoder& stream, std::uint32_t prediction,
                                              std::size_t context) {
    const unsigned width = stream.symbol(widths_.at(context));
    width_ = width;
    std::uint32_t difference = 0;
    if (width == 0) {
      difference = stream.bit(zero_or_one_) ? 1 : 0;
    } else if (Bits == 32 && width == 32) [[unlikely]] {
      difference = 0x80000000U;
    } else {
      difference = stream.symbol(differences_.at(width, 1U << std::min(width, kModelled)));
      if (width > kModelled) {
        const unsigned low_bits = width - kModelled;
        difference = difference << low_bits | stream.raw(low_bits);
      }
      // The upper half stands for 2^(width-1) + 1 to 2^width, the lower one for the negatives.
      const std::uint32_t negative = difference - ((1U << width) - 1);
      difference = (difference >> (width - 1)) != 0 ? difference + 1 : negative;
    }
    return (prediction + difference) & kMask;
  }

  /// Bits of the difference decoded last, 0 to Bits: a context for other decoders.
  [[nodiscard]] unsigned width() const { return width_; }

 private:
  static constexpr unsigned kModelled = 8;  // further bits are raw
  static constexpr std::uint32_t kMask = 0xFFFFFFFFU >> (32 - Bits);

  SymbolModels<Bits + 1> widths_;  // by context
  SymbolModels<256> differences_;  // by width
  BitModel zero_or_one_;           // of width 0
  unsigned width_ = 0;
};

}  // namespace spillway::formats::laz
