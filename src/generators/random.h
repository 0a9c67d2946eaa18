#pragma once
// Random numbers that are the same on every machine: 64-bit integers, and doubles made of them with
// operations that IEEE 754 rounds in one way only (no library logarithm, sine or distribution).

#include <array>
#include <cstdint>

#include "src/rooms.h"

namespace spillway::generators {

/// A bijection of 64-bit integers whose bits look random: the finalizer of SplitMix64 (Steele, Lea,
/// Flood, "Fast Splittable Pseudorandom Number Generators", OOPSLA 2014).
constexpr std::uint64_t mix_bits(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

/// SplitMix64 entered at any place: draw number `counter`, and those after it, of a seed's
/// sequence.
class Random {
 public:
  explicit constexpr Random(std::uint64_t seed, std::uint64_t counter = 0)
      : state_(mix_bits(seed + kStep) + counter * kStep) {}

  /// The draws that belong to point `index` of a family. Each point has kDrawsPerPoint of its own.
  static constexpr Random of_point(std::uint64_t seed, std::uint64_t index) {
    return Random(seed, index * kDrawsPerPoint);
  }

  /// 64 random bits.
  constexpr std::uint64_t bits() { return mix_bits(state_ += kStep); }

  /// A multiple of 2^-53 in [0, 1).
  constexpr double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }

  /// An integer in [0, n), for n below 2^32.
  constexpr std::uint64_t below(std::uint64_t n) { return ((bits() >> 32) * n) >> 32; }

  /// A uniform point of the unit disc without its centre, and its squared distance from there.
  struct InDisc {
    double u, v, squared_norm;
  };
  InDisc in_disc();

  /// Two independent normal numbers of mean 0 and variance 1: Marsaglia's polar method.
  std::array<double, 2> normal_pair();

 private:
  static constexpr std::uint64_t kStep = 0x9e3779b97f4a7c15ULL;
  static constexpr std::uint64_t kDrawsPerPoint = 32;

  std::uint64_t state_;
};

/// The natural logarithm of a normal positive double, to a few units in the last place, by
/// additions, multiplications and divisions only.
double portable_log(double x);

}  // namespace spillway::generators
