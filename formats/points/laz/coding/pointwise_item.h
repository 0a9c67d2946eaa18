#pragma once

#include <cstddef>
#include <cstdint>

#include "formats/points/laz/coding/arithmetic_decoder.h"

namespace spillway::detail::laz {

/// A part of the record in a pointwise chunk. All parts share one stream, so each takes its symbols
/// for every point, but keeps of the values only what later symbols depend on.
class PointwiseItem {
 public:
  virtual ~PointwiseItem() = default;
  /// Begins a chunk, after its first point.
  virtual void reset() = 0;
  /// Takes this item's symbols of the next point.
  virtual void decode(ArithmeticDecoder& stream) = 0;
};

/// What is wanted of the first 20 bytes of a record, and what their decoding needs.
struct Point10 {
  std::int32_t x = 0;
  std::int32_t y = 0;
  std::int32_t z = 0;
  std::uint8_t returns = 0;  ///< bits 0-2: return number, 3-5: number of returns, 6: scan direction
  std::uint8_t classification = 0;  ///< bits 0-4: class, 5: synthetic, 6: key-point, 7: withheld
  std::uint8_t user = 0;

  /// Reads a record as it is without compression.
  static Point10 of_record(const std::byte* record);
};

/// The item that all others follow.
class Point10Item : public PointwiseItem {
 public:
  /// The point decoded last. After reset(), and before decode(), it is to be the chunk's first.
  Point10 point;
};

}  // namespace spillway::detail::laz
