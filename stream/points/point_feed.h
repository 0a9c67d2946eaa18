#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>

#include "formats/points/common/point_reader.h"

namespace spillway::detail {

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

/// Where a tree's points come from.
struct PointFeed {
  /// Takes the next piece, in order; false at the end.
  std::function<bool(SourcePiece&)> fetch;
  /// Makes points of a piece; called by many threads at a time.
  std::function<void(SourcePiece&, PointBlock&)> decode;
};

}  // namespace spillway::detail
