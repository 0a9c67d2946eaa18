#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "src/generators/random.h"

namespace spillway::generators {

/// A seeded permutation of [0, count) in constant memory. A bijection of the numbers of as many
/// bits as count - 1 has is applied until it leads below count ("cycle walking": J. Black, P.
/// Rogaway, "Ciphers with Arbitrary Finite Domains", CT-RSA 2002), twice in the mean at most.
class Shuffle {
 public:
  Shuffle(std::uint64_t seed, std::uint64_t count)
      : count_(count),
        mask_(count > 1 ? ~std::uint64_t{0} >> std::countl_zero(count - 1) : 0),
        shift_((std::bit_width(mask_) + 1) / 2) {
    Random random(seed);
    for (std::uint64_t& key : keys_) key = random.bits();
  }

  /// The place of `index` < count.
  std::uint64_t operator()(std::uint64_t index) const {
    do {
      index = mixed(index);
    } while (index >= count_);
    return index;
  }

 private:
  [[nodiscard]] std::uint64_t mixed(std::uint64_t x) const {
    // Each step can be undone within the bits of the mask.
    for (const std::uint64_t key : keys_) {
      x = ((x ^ key) * kOdd) & mask_;
      x ^= x >> shift_;
    }
    return x;
  }

  static constexpr std::uint64_t kOdd = 0xbf58476d1ce4e5b9ULL;

  std::uint64_t count_;
  std::uint64_t mask_;
  int shift_;
  std::array<std::uint64_t, 4> keys_{};
};

}  // namespace spillway::generators
