#include "stream/tiles/storage/stored_points.h"

#include <span>

#include "stream/points/encoded_points.h"

namespace spillway::stream {

void drain_points(StoredTile& stored, const std::function<void(const PointsView&)>& take) {
  for (StoredTile::Segment& segment : stored.segments) {
    PointBlock points;
    for (const EncodedBlock& block : find_blocks(segment.bytes, segment.where)) {
      decode_points(std::span<const std::byte>(segment.bytes).subspan(block.offset, block.size),
                    segment.where, points);
      take(PointsView::of(points));
    }
    std::vector<std::byte>().swap(segment.bytes);
    segment.buffer.drain(take);
  }
}

}  // namespace spillway::stream
