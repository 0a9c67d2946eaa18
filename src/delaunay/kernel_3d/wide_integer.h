#pragma once
// Integers of a fixed number of 64-bit limbs, two's complement, for the exact stage of the 3D
// kernel's predicates. Whoever uses them sees to it that results fit.

#include <array>
#include <cstdint>

#include "src/delaunay/kernel_common/lanes.h"
#include "src/geometry/predicate_stages.h"

namespace spillway::delaunay::kernel_3d {

__extension__ using Uint128 = unsigned __int128;

template <int kLimbs>
struct WideInteger {
  std::array<std::uint64_t, kLimbs> limbs;  ///< the lowest first

  [[nodiscard]] bool negative() const { return limbs[kLimbs - 1] >> 63 != 0; }
};

template <int kLimbs>
SPILLWAY_INLINE int sign(const WideInteger<kLimbs>& a) {
  if (a.negative()) return -1;
  std::uint64_t any = 0;
  for (const std::uint64_t limb : a.limbs) any |= limb;
  return any != 0 ? 1 : 0;
}

template <int kLimbs>
SPILLWAY_INLINE WideInteger<kLimbs> operator+(const WideInteger<kLimbs>& a,
                                              const WideInteger<kLimbs>& b) {
  WideInteger<kLimbs> sum;
  Uint128 carry = 0;
  for (int i = 0; i < kLimbs; ++i) {
    carry += Uint128{a.limbs[i]} + b.limbs[i];
    sum.limbs[i] = static_cast<std::uint64_t>(carry);
    carry >>= 64;
  }
  return sum;
}

template <int kLimbs>
SPILLWAY_INLINE WideInteger<kLimbs> operator-(const WideInteger<kLimbs>& a,
                                              const WideInteger<kLimbs>& b) {
  WideInteger<kLimbs> difference;
  std::uint64_t borrow = 0;
  for (int i = 0; i < kLimbs; ++i) {
    const Uint128 step = Uint128{a.limbs[i]} - b.limbs[i] - borrow;
    difference.limbs[i] = static_cast<std::uint64_t>(step);
    borrow = static_cast<std::uint64_t>(step >> 64) & 1;
  }
  return difference;
}

/// The product, with all its limbs.
template <int kA, int kB>
SPILLWAY_INLINE WideInteger<kA + kB> operator*(const WideInteger<kA>& a, const WideInteger<kB>& b) {
  WideInteger<kA + kB> product{};
  if constexpr (kA == 1 && kB == 1) {
    const auto both = static_cast<Uint128>(stages::Int128{static_cast<std::int64_t>(a.limbs[0])} *
                                           static_cast<std::int64_t>(b.limbs[0]));
    return {{static_cast<std::uint64_t>(both), static_cast<std::uint64_t>(both >> 64)}};
  }
  for (int i = 0; i < kA; ++i) {
    std::uint64_t carry = 0;
    for (int j = 0; j < kB; ++j) {
      const Uint128 step = Uint128{a.limbs[i]} * b.limbs[j] + product.limbs[i + j] + carry;
      product.limbs[i + j] = static_cast<std::uint64_t>(step);
      carry = static_cast<std::uint64_t>(step >> 64);
    }
    product.limbs[i + kB] = carry;
  }
  // A negative factor was taken for itself plus 2^(64 limbs).
  const auto correct = [&product]<int kOther>(bool needed, const WideInteger<kOther>& other) {
    const std::uint64_t mask = needed ? ~std::uint64_t{0} : 0;
    std::uint64_t borrow = 0;
    for (int i = 0; i < kOther; ++i) {
      std::uint64_t& limb = product.limbs[kA + kB - kOther + i];
      const Uint128 step = Uint128{limb} - (other.limbs[i] & mask) - borrow;
      limb = static_cast<std::uint64_t>(step);
      borrow = static_cast<std::uint64_t>(step >> 64) & 1;
    }
  };
  correct(a.negative(), b);
  correct(b.negative(), a);
  return product;
}

}  // namespace spillway::delaunay::kernel_3d
