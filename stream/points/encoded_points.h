#pragma once
// How points lie in scratch files: blocks (formats/blocks/block.h) of up to some thousand points,
// each the columns x, y, z and, where wanted, the index (formats/blocks/columns.h), and then the
// byte planes of attributes, where points carry any. The head tells their number.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "formats/points/common/point_reader.h"
#include "src/error.h"
#include "stream/points/point_buffer.h"
#include "stream/points/points_view.h"

namespace spillway::stream {

/// Throws Failure(kInvalidArgument) for more bytes of attributes than a point may have that waits.
void refuse_large_records(std::size_t record_size);

/// Where a block lies in a file, and how many points it holds.
struct EncodedBlock {
  std::uint64_t offset = 0;
  std::size_t size = 0;
  std::size_t points = 0;
};

/// Appends a buffer's points to `bytes` as blocks, as few as can be, and lets go of them. The
/// blocks' offsets are counted from the beginning of `bytes`.
std::vector<EncodedBlock> encode_points(PointBuffer& points, std::vector<std::byte>& bytes);

/// The blocks that `bytes` consist of, by their heads; what comes after the last whole one is left
/// out. Throws BadInput of `where`, the spot of the first byte, for what is no head.
std::vector<EncodedBlock> find_blocks(std::span<const std::byte> bytes, const FileSpot& where);

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

}  // namespace spillway::stream
