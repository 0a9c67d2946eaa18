#include "tests/formats/points/laz/laz_encoder/integer_compressor.h"

#include <algorithm>
#include <bit>

namespace spillway::detail::testing {

IntegerCompressor::IntegerCompressor(unsigned bits, std::size_t contexts)
    : bits_(bits), classes_(contexts, bits + 1) {
  for (unsigned k = 0; k <= bits; ++k) {
    correctors_.emplace_back(1, std::uint32_t{1} << std::min(k, 8U));
  }
}

void IntegerCompressor::encode(ArithmeticEncoder& encoder, std::int32_t prediction,
                               std::int32_t value, std::size_t context) {
  // The difference, from -2^(bits-1) to 2^(bits-1) - 1.
  const std::uint32_t difference =
      static_cast<std::uint32_t>(value) - static_cast<std::uint32_t>(prediction);
  const std::int64_t c =
      static_cast<std::int32_t>(difference << (32 - bits_)) / (std::int64_t{1} << (32 - bits_));

  // Class k holds -(2^k - 1) ... -2^(k-1) and 2^(k-1) + 1 ... 2^k; class 0 holds 0 and 1.
  k_ = static_cast<unsigned>(std::bit_width(static_cast<std::uint64_t>(c <= 0 ? -c : c - 1)));
  encoder.symbol(k_, classes_[context]);
  if (k_ == 0) {
    encoder.bit(static_cast<unsigned>(c), zero_or_one_);
    return;
  }
  if (k_ == 32) return;
  const auto code = static_cast<std::uint32_t>(c > 0 ? c - 1 : c + (std::int64_t{1} << k_) - 1);
  const unsigned raw_bits = k_ > 8 ? k_ - 8 : 0;
  encoder.symbol(code >> raw_bits, correctors_[k_][0]);
  if (raw_bits > 0) encoder.raw(code & ((std::uint32_t{1} << raw_bits) - 1), raw_bits);
}

}  // namespace spillway::detail::testing
