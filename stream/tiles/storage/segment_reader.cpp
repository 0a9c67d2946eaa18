#include "stream/tiles/storage/segment_reader.h"

#include <algorithm>

#include "stream/points/encoded_points.h"

namespace spillway::stream {
namespace {

/// Bytes that are read at a time, if a block is not larger.
constexpr std::size_t kReadBytes = std::size_t{256} << 10;
/// ... of which at most so many points are taken, as equal ones take next to no bytes.
constexpr std::size_t kReadPoints = 65'536;

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
  std::vector<EncodedBlock> found;
  for (std::size_t size = kReadBytes; found.empty(); size *= 2) {
    blocks.bytes.resize(std::min<std::uint64_t>(size, left));
    stretch.file().read(offset, blocks.bytes);
    found = find_blocks(blocks.bytes, blocks.where);
    if (found.empty() && blocks.bytes.size() == left) {
      throw BadInput(blocks.where, "the block is cut short");
    }
  }
  std::size_t points = 0;
  std::size_t taken = 0;
  for (; taken < found.size() && points < kReadPoints; ++taken) points += found[taken].points;
  blocks.bytes.resize(found[taken - 1].offset + found[taken - 1].size);
  done_ += blocks.bytes.size();
  points_done_ += points;
  points_ += points;
}

}  // namespace spillway::stream
