#include "stream/tiles/storage/tile.h"

namespace spillway::detail {

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

}  // namespace spillway::detail
