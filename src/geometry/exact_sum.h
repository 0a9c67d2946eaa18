#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace spillway::geometry {

/// A sum of doubles without any rounding, so that their order makes no difference: a fixed-point
/// number that holds all finite doubles (R. Neal, "Fast exact summation using small and large
/// superaccumulators", 2015).
class ExactSum {
 public:
  /// Must be finite.
  void add(double number) {
    if (number == 0) return;
    const auto bits = std::bit_cast<std::uint64_t>(number);
    const auto exponent = static_cast<unsigned>(bits >> 52 & 0x7ff);
    std::uint64_t digits = bits & ((std::uint64_t{1} << 52) - 1);
    if (exponent != 0) digits |= std::uint64_t{1} << 52;
    const unsigned place = exponent == 0 ? 0 : exponent - 1;  // of the lowest bit, above 2^-1074
    const std::size_t limb = place / kBits;
    const unsigned shift = place % kBits;
    const auto low = static_cast<std::int64_t>(digits << shift & kMask);
    const auto middle = static_cast<std::int64_t>(digits >> (kBits - shift) & kMask);
    const auto high =
        static_cast<std::int64_t>(shift == 0 ? 0 : digits >> (2 * kBits - shift) & kMask);
    const std::int64_t sign = number < 0 ? -1 : 1;
    limbs_[limb] += sign * low;
    limbs_[limb + 1] += sign * middle;
    limbs_[limb + 2] += sign * high;
    if (++added_ == kMostAdded) carry();
  }

  void add(const ExactSum& other) {
    ExactSum more = other;
    more.carry();
    carry();
    for (std::size_t i = 0; i < kLimbs; ++i) limbs_[i] += more.limbs_[i];
    carry();
  }

  /// The sum, off by no more than some units of its last bit; the same for the same sum.
  [[nodiscard]] double value() const {
    ExactSum magnitude = *this;
    magnitude.carry();
    const bool is_negative = magnitude.limbs_.back() < 0;
    if (is_negative) {
      for (std::int64_t& limb : magnitude.limbs_) limb = -limb;
      magnitude.carry();
    }
    double sum = 0;
    for (std::size_t i = kLimbs; i-- > 0;) {
      sum +=
          std::ldexp(static_cast<double>(magnitude.limbs_[i]), static_cast<int>(i * kBits) - 1074);
    }
    return is_negative ? -sum : sum;
  }

 private:
  static constexpr unsigned kBits = 32;
  static constexpr std::uint64_t kMask = (std::uint64_t{1} << kBits) - 1;
  static constexpr std::size_t kLimbs = 2098 / kBits + 4;
  static constexpr std::uint32_t kMostAdded = std::uint32_t{1} << 30;

  /// Brings all limbs but the highest to 0 ... 2^32 - 1.
  void carry() {
    std::int64_t over = 0;
    for (std::size_t i = 0; i + 1 < kLimbs; ++i) {
      const std::int64_t limb = limbs_[i] + over;
      limbs_[i] = limb & static_cast<std::int64_t>(kMask);
      over = limb >> kBits;
    }
    limbs_[kLimbs - 1] += over;
    added_ = 0;
  }

  std::array<std::int64_t, kLimbs> limbs_{};
  std::uint32_t added_ = 0;  ///< since the last carry
};

}  // namespace spillway::geometry
