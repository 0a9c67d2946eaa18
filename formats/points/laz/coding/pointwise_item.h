#pragma once

#include <cstddef>
#include <cstdint>

#include "formats/points/laz/coding/arithmetic_decoder.h"
#include "formats/points/laz/coding/kept_part.h"

namespace spillway::formats::laz {

/// A part of the record in a pointwise chunk. All parts share one stream, so each takes its symbols
/// for every point, whatever it keeps.
class PointwiseItem {
 public:
  virtual ~PointwiseItem() = default;
  /// Begins a chunk; `first` is this part of its first record.
  virtual void reset(const std::byte* first) = 0;
  /// Takes this item's symbols of the next point. Of an item that keeps all, `part` is this part of
  /// the last record, and becomes that of the next one; others do not look at it.
  virtual void decode(ArithmeticDecoder& stream, std::byte* part) = 0;
};

/// What is needed of the first 20 bytes of a record: what is wanted without whole records, and what
/// decoding depends on.
struct Point10 {
  std::int32_t x = 0;
  std::int32_t y = 0;
  std::int32_t z = 0;
  std::uint8_t returns = 0;  ///< bits 0-2: return number, 3-5: number of returns, 6: scan direction
  std::uint8_t classification = 0;  ///< bits 0-4: class, 5: synthetic, 6: key-point, 7: withheld
  std::uint8_t user = 0;

  /// Reads a record as it is without compression.
  static Point10 of_record(const std::byte* record);
  /// Writes these fields likewise.
  void store_in(std::byte* record) const;
};

/// The item that all others follow.
class Point10Item : public PointwiseItem {
 public:
  /// The point decoded last, after reset() the chunk's first one.
  [[nodiscard]] const Point10& point() const { return point_; }

 protected:
  Point10 point_;
};

}  // namespace spillway::formats::laz
