#include "stream/library/tiling/records_by_tile.h"

#include <fmt/format.h>

#include "src/error.h"

namespace spillway::stream {

namespace {

/// What a tile takes besides its records.
constexpr std::uint64_t kTileBytes = 256;

}  // namespace

void RecordsByTile::make_tile(std::size_t number) {
  if ((number + 1) * kTileBytes > memory_) {
    throw InvalidArgument(fmt::format(
        "there would be more than {} tiles: choose larger ones, or more memory", number));
  }
  tiles_.resize(number + 1);
}

void RecordsByTile::add(std::size_t tile, std::span<const std::byte> record) {
  if (tile >= tiles_.size()) make_tile(tile);
  std::vector<std::byte>& latest = tiles_[tile].latest;
  latest.insert(latest.end(), record.begin(), record.end());
  in_memory_ += record.size();
  if (in_memory_ > memory_) spill();
}

void RecordsByTile::spill() {
  if (!file_) file_ = scratch_.create(name_);
  for (Tile& tile : tiles_) {
    const std::vector<std::byte> bytes = std::exchange(tile.latest, {});
    if (bytes.empty()) continue;
    const Batch batch{file_->size(), bytes.size()};
    file_->append(std::as_bytes(std::span(&tile.spilled, 1)));
    file_->append(bytes);
    tile.spilled = batch;
  }
  in_memory_ = 0;
}

std::vector<std::size_t> RecordsByTile::tiles() const {
  std::vector<std::size_t> numbers;
  for (std::size_t t = 0; t < tiles_.size(); ++t) {
    if (tiles_[t].spilled.bytes > 0 || !tiles_[t].latest.empty()) numbers.push_back(t);
  }
  return numbers;
}

RecordsByTile::Reader::Reader(const RecordsByTile& all, std::size_t tile)
    : all_(all), tile_(all.tiles_[tile]) {
  for (Batch batch = tile_.spilled; batch.bytes > 0;) {
    spilled_.push_back(batch);
    all_.file_->read(batch.offset, std::as_writable_bytes(std::span(&batch, 1)));
  }
}

bool RecordsByTile::Reader::next(std::vector<std::byte>& bytes) {
  if (!spilled_.empty()) {
    bytes.resize(spilled_.back().bytes);
    all_.file_->read(spilled_.back().offset + sizeof(Batch), bytes);
    spilled_.pop_back();
    return true;
  }
  if (!std::exchange(has_latest_, false)) return false;
  bytes = tile_.latest;
  return !bytes.empty();
}

}  // namespace spillway::stream
