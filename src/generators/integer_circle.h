#pragma once

#include <array>
#include <cstdint>

#include "src/rooms.h"

namespace spillway::generators {

/// A Gaussian integer.
struct Gaussian {
  std::int64_t re, im;

  Gaussian operator*(const Gaussian& o) const {
    return {re * o.re - im * o.im, re * o.im + im * o.re};
  }
};

/// All integer points of the circle whose radius is the product of the first few primes of the form
/// 4k + 1. Such a prime is norm(g) for a Gaussian integer g, and the product over the primes of one
/// of g^2, |g|^2, conj(g)^2 each, times a unit, runs through the 4 * 3^primes points.
class IntegerCircle {
 public:
  static constexpr int kMostPrimes = 10;  ///< the radius stays below 2^50

  explicit IntegerCircle(int primes) : primes_(primes) {
    for (int k = 0; k < primes; ++k) {
      radius_ *= norm(kFactors[k]);
      count_ *= 3;
    }
  }

  [[nodiscard]] std::int64_t radius() const { return radius_; }
  [[nodiscard]] std::uint64_t count() const { return 4 * count_; }
  /// Points with re > 0 and one of the two with re = 0.
  [[nodiscard]] std::uint64_t half_count() const { return 2 * count_; }

  /// Point number `index` < count(). Numbers below half_count() are never opposite each other, so
  /// that half() runs through all points of the half circle re >= 0 (but one).
  [[nodiscard]] Gaussian point(std::uint64_t index) const {
    constexpr std::array<Gaussian, 4> kUnits = {{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
    Gaussian product = kUnits[index / count_];
    std::uint64_t digits = index % count_;
    for (int k = 0; k < primes_; ++k, digits /= 3) {
      const Gaussian g = kFactors[k];
      const Gaussian conjugate = {g.re, -g.im};
      switch (digits % 3) {
        case 0:
          product = product * g * g;
          break;
        case 1:
          product = product * g * conjugate;
          break;
        default:
          product = product * conjugate * conjugate;
      }
    }
    return product;
  }

  [[nodiscard]] Gaussian half(std::uint64_t index) const {
    const Gaussian p = point(index);
    return p.re < 0 ? Gaussian{-p.re, -p.im} : p;
  }

 private:
  static constexpr std::int64_t norm(const Gaussian& g) { return g.re * g.re + g.im * g.im; }

  // Of norm 5, 13, 17, 29, 37, 41, 53, 61, 73, 89.
  static constexpr std::array<Gaussian, kMostPrimes> kFactors = {
      {{2, 1}, {3, 2}, {4, 1}, {5, 2}, {6, 1}, {5, 4}, {7, 2}, {6, 5}, {8, 3}, {8, 5}}};

  int primes_;
  std::int64_t radius_ = 1;
  std::uint64_t count_ = 1;
};

}  // namespace spillway::generators
