#pragma once
// How points lie in a tile's file: blocks (formats/blocks/block.h) of up to some thousand points,
// each the columns x, y, z and, where wanted, the index (formats/blocks/columns.h), and then the
// byte planes of attributes, where points carry any. The head tells their number.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "formats/points/common/point_reader.h"
#include "src/delaunay/common/working_memory.h"
#include "src/error.h"
#include "src/geometry/point.h"
#include "stream/points/point_buffer.h"
#include "stream/points/points_view.h"

namespace spillway::detail {

/// The points of a tile, ready to be triangulated, in the order in which they were read.
template <int D>
struct TilePoints {
  std::vector<Point<D>> points;
  std::vector<double> heights;        ///< D = 2: z, one a point
  std::vector<std::uint64_t> index;   ///< one a point, or none
  std::vector<std::byte> attributes;  ///< a record a point, or none
  std::uint64_t left_out = 0;         ///< points equal to one of these that are not among them

  void resize(std::size_t count, bool with_index, std::size_t record_size) {
    resize(points, count);
    if constexpr (D == 2) resize(heights, count);
    if (with_index) resize(index, count);
    if (record_size > 0) resize(attributes, count * record_size);
  }
  /// Puts what points have besides coordinates into the places from `first` on.
  void set_carried(std::size_t first, const PointsView& some) {
    std::ranges::copy(some.index, index.data() + (some.index.empty() ? 0 : first));
    std::ranges::copy(some.attributes, attributes.data() + first * some.record_size());
  }
  /// Puts a point into a place.
  void set(std::size_t place, const LatticePoint& point) {
    if constexpr (D == 2) {
      points[place] = {point[0], point[1]};
      heights[place] = point[2];
    } else {
      points[place] = point;
    }
  }

 private:
  template <typename T>
  static void resize(std::vector<T>& values, std::size_t count) {
    values.reserve(count);
    ask_for_huge_pages(values.data(), count * sizeof(T));
    values.resize(count);
  }
};

/// What a point takes in it, with an index, and with its number while it is triangulated; its
/// attributes come on top.
constexpr std::uint64_t kLoadedPointBytes =
    sizeof(LatticePoint) + sizeof(std::uint64_t) + sizeof(std::uint32_t);

/// Throws Error(kInvalidArgument) for more bytes of attributes than a point may have that waits.
void refuse_large_records(std::size_t record_size);

/// Where a block lies in a tile's file, and how many points it holds.
struct TileBlock {
  std::uint64_t offset = 0;
  std::size_t size = 0;
  std::size_t points = 0;
};

/// Appends a buffer's points to `bytes` as blocks, as few as can be, and lets go of them. The
/// blocks' offsets are counted from the beginning of `bytes`.
std::vector<TileBlock> encode_points(PointBuffer& points, std::vector<std::byte>& bytes);

/// The blocks that `bytes` consist of, by their heads; what comes after the last whole one is left
/// out. Throws BadInput of `where`, the spot of the first byte, for what is no head.
std::vector<TileBlock> find_blocks(std::span<const std::byte> bytes, const FileSpot& where);

/// Appends one block of points, at most PointBuffer::kChunk.
void append_points(std::vector<std::byte>& bytes, const PointsView& points);

/// Appends any number of points, as blocks one after the other.
void append_all_points(std::vector<std::byte>& bytes, const PointsView& points);

/// Replaces `points` by those of one block, given by its bytes. Throws BadInput of
/// `where` if the block is corrupt.
void decode_points(std::span<const std::byte> block, const FileSpot& where, PointBlock& points);

/// Likewise, by what append_all_points() wrote.
void decode_all_points(std::span<const std::byte> blocks, const FileSpot& where,
                       PointBlock& points);

}  // namespace spillway::detail
