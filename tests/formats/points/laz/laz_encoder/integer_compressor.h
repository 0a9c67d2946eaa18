#pragma once

#include <cstdint>

#include "tests/formats/points/laz/laz_encoder/arithmetic_encoder.h"

namespace spillway::detail::testing {

/// Writes integers of 8, 16 or 32 bits by their difference from a prediction, modulo 2^bits.
class IntegerCompressor {
 public:
  IntegerCompressor(unsigned bits, std::size_t contexts);

  /// Only the lowest `bits` of `prediction` and `value` count.
  void encode(ArithmeticEncoder& encoder, std::int32_t prediction, std::int32_t value,
              std::size_t context);

  /// Size class of the last difference.
  [[nodiscard]] unsigned k() const { return k_; }

 private:
  unsigned bits_;
  unsigned k_ = 0;
  SymbolModels classes_;
  BitModel zero_or_one_;
  std::vector<SymbolModels> correctors_;  // by class; each has one model
};

}  // namespace spillway::detail::testing
