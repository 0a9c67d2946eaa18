#include "stream/tiles/segment_reader.h"

#include <algorithm>

#include "stream/tiles/tile_block.h"

namespace spillway::detail {
namespace {

/// Bytes that are read at a time, if a block is not larger.
constexpr std::size_t kReadBytes = std::size_t{256} << 10;

}  // namespace

bool SegmentReader::fetch(StoredBlocks& blocks) {
  for (; segment_ < segments_.size(); ++segment_, done_ = 0, points_done_ = 0) {
    TileSegment& segment = segments_[segment_];
    if (done_ == 0 && !segment.follows) ++run_;
    if (done_ < segment.stretch->size()) {
      blocks.arrival = segment.arrival + points_done_;
      blocks.run = run_;
      read(*segment.stretch, blocks);
      return true;
    }
    segment = {};
  }
  return false;
}

void SegmentReader::read(const FileStretch& stretch, StoredBlocks& blocks) {
  const std::uint64_t offset = stretch.offset() + done_;
  const std::uint64_t left = stretch.size() - done_;
  blocks.where = {stretch.file().name(), at_byte(offset)};
  std::vector<TileBlock> found;
  for (std::size_t size = kReadBytes; found.empty(); size *= 2) {
    blocks.bytes.resize(std::min<std::uint64_t>(size, left));
    stretch.file().read(offset, blocks.bytes);
    found = find_blocks(blocks.bytes, blocks.where);
    if (found.empty() && blocks.bytes.size() == left) {
      throw BadInput(blocks.where, "the block is cut short");
    }
  }
  blocks.bytes.resize(found.back().offset + found.back().size);
  done_ += blocks.bytes.size();
  for (const TileBlock& block : found) {
    points_done_ += block.points;
    points_ += block.points;
  }
}

}  // namespace spillway::detail
