#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "src/geometry/point.h"

namespace spillway {

/// The order-independent fingerprint of a triangulation: the sum modulo 2^64, over its finite
/// simplices, of XXH3-64 of the D+1 vertices' coordinates (x, y or x, y, z as little-endian
/// doubles, negative zero counted as zero), the vertices sorted lexicographically. It depends
/// neither on the order of simplices or vertices nor on orientation, so runs and formats can be
/// compared by it.
template <int D>
requires SupportedDimension<D>
class CanonicalHash {
 public:
  /// Adds one finite simplex, given by its output coordinates in any order.
  void add(std::array<Point<D>, D + 1> simplex);

  /// Adds the simplices that another hash has seen.
  void add(const CanonicalHash& other) { sum_ += other.sum_; }

  [[nodiscard]] std::uint64_t value() const { return sum_; }

 private:
  std::uint64_t sum_ = 0;
};

/// The hash as it is printed everywhere: 16 lower-case hexadecimal digits.
std::string hash_to_hex(std::uint64_t hash);

}  // namespace spillway
