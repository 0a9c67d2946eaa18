#include "stream/tiles/storage/tile.h"

#include "stream/points/encoded_points.h"

namespace spillway::stream {

/// As in a tile's file, some pages at a time.
void HeldPoints::buffer_state(StateWriter& state) {
  std::uint64_t points = buffer.size();
  state(points);
  std::vector<std::byte> encoded;
  buffer.visit_all([&](const PointsView& some) {
    encoded.clear();
    append_all_points(encoded, some);
    state(encoded);
  });
}

void HeldPoints::buffer_state(StateReader& state) {
  std::uint64_t points = 0;
  state(points);
  std::vector<std::byte> encoded;
  PointBlock block;
  for (buffer = {}; buffer.size() < points;) {
    state(encoded);
    decode_all_points(encoded, {state.name(), {}}, block);
    buffer.append(PointsView::of(block));
  }
}

std::size_t Tile::room() const {
  std::size_t room = 0;
  for (const HeldPoints& some : held) room += some.buffer.room();
  return room;
}

std::size_t Tile::waiting() const {
  std::size_t waiting = 0;
  for (const HeldPoints& some : held) waiting += some.buffer.size();
  return waiting;
}

std::uint64_t Tile::held_bytes() const {
  std::uint64_t bytes = 0;
  for (const HeldPoints& some : held) bytes += some.buffer.bytes();
  return bytes;
}

std::uint64_t StoredTile::held_bytes() const {
  std::uint64_t bytes = 0;
  for (const Segment& segment : segments) bytes += segment.buffer.bytes();
  return bytes;
}

}  // namespace spillway::stream
