#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "formats/points/common/point_reader.h"

namespace spillway::stream {

/// A piece of one input, fetched but not decoded; or of points that are ready, without a reader.
struct SourcePiece {
  RawPoints raw;
  std::size_t input = 0;
  std::uint64_t first_index = 0;  ///< what the piece's numbers are counted from
  bool counted = true;            ///< decode() counts what becomes of its records
  std::size_t region = 0;         ///< position in the plan of the region that all its points are of
  std::uint64_t arrival = 0;  ///< of its first record: in the order of all inputs as they are named
  std::shared_ptr<const PointReader> reader;  ///< lives until its last piece is decoded
};

/// Where points come from.
class PointFeed {
 public:
  virtual ~PointFeed() = default;

  /// Takes the next piece, in order; false at the end.
  virtual bool fetch(SourcePiece& piece) = 0;
  /// Replaces `block` by the points of a piece, which is used up. Safe for many threads at a time.
  /// A block may be empty before the end.
  virtual void decode(SourcePiece& piece, PointBlock& block) = 0;
};

}  // namespace spillway::stream
