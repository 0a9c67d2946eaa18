#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <string>

#include "src/geometry/point.h"

namespace spillway::geometry {

/// The fingerprint of a vertex: XXH3-64 of its output coordinates (x, y or x, y, z as little-endian
/// doubles, negative zero counted as zero).
template <int D>
std::uint64_t vertex_hash(Point<D> position);

/// The order-independent fingerprint of a triangulation: the sum modulo 2^64, over its finite
/// simplices, of XXH3-64 of the sum modulo 2^64 (as a little-endian integer) of their D+1 vertices'
/// fingerprints. It depends neither on the order of simplices or vertices nor on orientation, so
/// runs and formats can be compared by it.
template <int D>
requires Dimension<D>
class CanonicalHash {
 public:
  /// Adds one finite simplex, given by its output coordinates in any order.
  void add(const std::array<Point<D>, D + 1>& simplex);

  /// Adds one finite simplex, given by the sum modulo 2^64 of its vertices' fingerprints.
  void add(std::uint64_t sum_of_vertices) {
    // XXH3-64 of eight bytes, without a call into the library.
    constexpr std::uint64_t kSecret = 0xC73AB174C5ECD5A2U;
    constexpr std::uint64_t kFactor = 0x9FB21C651E98DF25U;
    std::uint64_t h = std::rotl(sum_of_vertices, 32) ^ kSecret;
    h ^= std::rotl(h, 49) ^ std::rotl(h, 24);
    h *= kFactor;
    h ^= (h >> 35) + sizeof h;
    h *= kFactor;
    sum_ += h ^ (h >> 28);
  }

  /// Adds finite simplices of D+1 corners each, one after the other: places of `vertices`, the
  /// fingerprints of all vertices.
  void add(std::span<const std::uint32_t> corners, std::span<const std::uint64_t> vertices);

  /// Adds the simplices that another hash has seen.
  void add(const CanonicalHash& other) { sum_ += other.sum_; }

  [[nodiscard]] std::uint64_t value() const { return sum_; }

 private:
  std::uint64_t sum_ = 0;
};

/// The hash as it is printed everywhere: 16 lower-case hexadecimal digits.
std::string hash_to_hex(std::uint64_t hash);

}  // namespace spillway::geometry
