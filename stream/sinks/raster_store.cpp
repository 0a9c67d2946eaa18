#include "stream/sinks/raster_store.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <iterator>
#include <limits>
#include <utility>

#include "formats/blocks/block.h"
#include "formats/blocks/columns.h"
#include "formats/bytes/bytes.h"
#include "formats/state/state_reader.h"
#include "formats/state/state_writer.h"

namespace spillway::stream {
namespace {

// Spilled pixels are a block (docs/formats-blocks.md) of this kind: the number of runs; of each,
// its first pixel and its length; then the pixels of all runs as a column of their ordinals.
constexpr std::uint32_t kRasterTile = 0x52545344;

constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();

/// Tiles that the store should have room for besides those in hands.
constexpr std::size_t kLeastIdleTiles = 8;

struct Run {
  std::uint32_t begin;
  std::uint32_t length;
};

std::vector<Run> runs_of(std::span<const float> pixels) {
  std::vector<Run> runs;
  const auto count = static_cast<std::uint32_t>(pixels.size());
  for (std::uint32_t i = 0; i < count;) {
    if (std::isnan(pixels[i])) {
      ++i;
      continue;
    }
    const std::uint32_t begin = i;
    while (i < count && !std::isnan(pixels[i])) ++i;
    runs.push_back({begin, i - begin});
  }
  return runs;
}

/// The bits of a float, such that neighbours among floats are neighbours.
std::uint32_t ordinal_of(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  return (bits >> 31) != 0 ? ~bits : bits | 0x80000000;
}
float of_ordinal(std::uint32_t ordinal) {
  return std::bit_cast<float>((ordinal >> 31) != 0 ? ordinal & 0x7FFFFFFF : ~ordinal);
}

std::vector<std::byte> encode(std::span<const float> pixels, std::span<const Run> runs) {
  const auto count = static_cast<std::uint32_t>(runs.size());
  std::vector<std::byte> content(sizeof(count) + runs.size_bytes());
  std::memcpy(content.data(), &count, sizeof(count));
  std::ranges::copy(std::as_bytes(runs), content.begin() + sizeof(count));
  std::vector<std::uint32_t> ordinals;
  ordinals.reserve(pixels.size());
  for (const Run& run : runs) {
    std::ranges::transform(pixels.subspan(run.begin, run.length), std::back_inserter(ordinals),
                           ordinal_of);
  }
  append_column(content, ordinals);
  std::vector<std::byte> block;
  append_block(block, kRasterTile, content);
  return block;
}

// Whether the value of a kPreferred pixel is only provisional, as no preferred one has come, is
// marked by the sign bit. Values have no signs, so it is free; what they bring in it is cleared.
float as_preferred(float value) { return std::copysign(value, 1.0F); }
float as_provisional(float value) { return std::copysign(value, -1.0F); }
bool is_provisional(float pixel) { return std::signbit(pixel); }

/// Floats count one by one up to here.
constexpr float kLargestSum = 0x1p24F;

/// What becomes of a pixel that holds `old` when `value` comes.
float combined(float old, float value, PixelRule rule) {
  if (std::isnan(old)) return value;
  switch (rule) {
    case PixelRule::kEqual:
      return value;
    case PixelRule::kPreferred:
      if (!is_provisional(value)) return value;
      // Of two provisional values the smaller one: their marks are minuses.
      return is_provisional(old) ? std::max(old, value) : old;
    case PixelRule::kSum:
      return std::min(old + value, kLargestSum);
  }
  return value;
}

}  // namespace

void put_pixel(float& pixel, float value, PixelRule rule, bool preferred) {
  if (rule == PixelRule::kEqual || (rule == PixelRule::kPreferred && preferred)) {
    set_pixel(pixel, rule == PixelRule::kPreferred ? as_preferred(value) : value);
    return;
  }
  const std::atomic_ref<float> shared(pixel);
  const float coming = rule == PixelRule::kPreferred ? as_provisional(value) : value;
  float old = shared.load(std::memory_order_relaxed);
  while (
      !shared.compare_exchange_weak(old, combined(old, coming, rule), std::memory_order_relaxed)) {
  }
}

/// While it exists, pixels of a tile are on their way, and the store is not locked.
class RasterStore::Move {
 public:
  Move(RasterStore& store, Tile& tile, std::unique_lock<std::mutex>& lock)
      : store_(store), tile_(tile), lock_(lock) {
    ++tile_.moving;
    lock_.unlock();
  }
  ~Move() {
    lock_.lock();
    --tile_.moving;
    store_.moved_.notify_all();
  }
  Move(const Move&) = delete;
  Move& operator=(const Move&) = delete;

 private:
  RasterStore& store_;
  Tile& tile_;
  std::unique_lock<std::mutex>& lock_;
};

RasterStore::RasterStore(std::vector<PixelRule> bands, std::uint64_t memory, ScratchFolder& scratch,
                         PixelsOfTile wanted, TileClosed told)
    : bands_(std::move(bands)),
      memory_(memory),
      scratch_(scratch),
      wanted_(std::move(wanted)),
      told_(std::move(told)) {}

std::uint64_t RasterStore::least_memory(std::size_t bands, unsigned threads) {
  return bands * kTilePixels * sizeof(float) * (kTilesInHand * threads + kLeastIdleTiles);
}

void RasterStore::Hand::release() {
  for (Held& held : held_) let_go(held);
}

void RasterStore::Hand::let_go(Held& held) {
  const auto [number, pixels, decided] = std::exchange(held, {});
  if (pixels != nullptr) store_.let_go(number, decided);
}

float* RasterStore::Hand::take_up(std::uint64_t number) {
  Held& held = held_[next_ % kTilesInHand];
  let_go(held);
  held = {number, store_.hold(number)};
  if (held.pixels == nullptr) return nullptr;
  ++next_;
  latest_ = &held;
  return held.pixels;
}

float* RasterStore::hold(std::uint64_t number) {
  std::unique_lock lock(mutex_);
  const auto is_closed = [&] {
    const auto found = tiles_.find(number);
    return found != tiles_.end() && found->second.closed;
  };
  if (is_closed()) return nullptr;
  if (const auto found = tiles_.find(number);
      found == tiles_.end() || found->second.pixels.empty()) {
    std::vector<float> pixels = empty_tile(lock);
    if (is_closed()) {
      --in_memory_;
      return nullptr;
    }
    Tile& tile = tiles_[number];
    if (tile.pixels.empty()) {
      tile.pixels = std::move(pixels);
      ++tile.hands;
      return tile.pixels.data();
    }
    --in_memory_;  // another thread has come first
  }
  Tile& tile = tiles_[number];
  if (tile.hands++ == 0) idle_.erase(tile.place);
  return tile.pixels.data();
}

void RasterStore::let_go(std::uint64_t number, std::uint32_t decided) {
  {
    const std::lock_guard lock(mutex_);
    Tile& tile = tiles_[number];
    tile.decided += decided;
    if (--tile.hands > 0) return;
    tile.closed = wanted_ && tile.decided > 0 && tile.decided == wanted_(number);
    if (!tile.closed) {
      tile.place = idle_.insert(idle_.end(), number);
      return;
    }
    closed_.push_back(number);
    ++closed_tiles_;
  }
  if (told_) told_(number);
}

/// For one more tile.
bool RasterStore::has_room() const {
  return in_memory_ * tile_bytes() + packed_bytes_ + tile_bytes() <= memory_;
}

/// Makes room by what is closed; false if that is not enough.
bool RasterStore::make_room(std::unique_lock<std::mutex>& lock) {
  while (!has_room()) {
    if (!closed_.empty()) {
      pack_closed(lock);
    } else if (!packed_.empty()) {
      write_packed(lock);
    } else {
      return false;
    }
  }
  return true;
}

void RasterStore::pack_closed(std::unique_lock<std::mutex>& lock) {
  const std::uint64_t number = closed_.front();
  closed_.pop_front();
  const auto found = tiles_.find(number);
  if (found == tiles_.end() || found->second.pixels.empty()) return;  // taken
  Tile& tile = found->second;
  std::vector<float> pixels = std::exchange(tile.pixels, {});
  std::vector<std::byte> packed;
  {
    const Move move(*this, tile, lock);
    packed = encode(pixels, runs_of(pixels));
    packed.shrink_to_fit();
    pixels = {};
  }
  --in_memory_;
  packed_bytes_ += packed.size();
  packed_.push_back(number);
  tile.packed = std::move(packed);
}

void RasterStore::write_packed(std::unique_lock<std::mutex>& lock) {
  const std::uint64_t number = packed_.front();
  packed_.pop_front();
  const auto found = tiles_.find(number);
  if (found == tiles_.end() || found->second.packed.empty()) return;  // taken
  const std::vector<std::byte> packed = std::exchange(found->second.packed, {});
  {
    const Move move(*this, found->second, lock);
    append_encoded(number, packed);
  }
  packed_bytes_ -= packed.size();
}

/// Memory for one more tile, counted: that of the longest unused one if there is no other.
std::vector<float> RasterStore::empty_tile(std::unique_lock<std::mutex>& lock) {
  std::vector<float> pixels;
  if (make_room(lock) || idle_.empty()) {
    ++in_memory_;
    lock.unlock();
    pixels.assign(tile_floats(), kNothing);
    lock.lock();
  } else {
    const std::uint64_t number = idle_.front();
    idle_.pop_front();
    Tile& tile = tiles_[number];
    pixels = std::exchange(tile.pixels, {});
    const Move move(*this, tile, lock);
    append(number, pixels);
    std::fill(pixels.begin(), pixels.end(), kNothing);
  }
  return pixels;
}

void RasterStore::append(std::uint64_t number, std::span<const float> pixels) {
  const std::vector<Run> runs = runs_of(pixels);
  if (runs.empty()) return;
  append_encoded(number, encode(pixels, runs));
}

void RasterStore::append_encoded(std::uint64_t number, std::span<const std::byte> block) {
  SpilledPixels stored{0, static_cast<std::uint32_t>(block.size())};
  {
    const std::lock_guard lock(file_mutex_);
    if (!file_) file_ = scratch_.create("raster");
    stored.offset = file_->size();
    file_->append(block);
  }
  const std::lock_guard lock(mutex_);
  tiles_[number].spilled.push_back(stored);
}

/// What is provisional stays so.
void RasterStore::take_as_it_is(std::uint64_t number, std::vector<float>& pixels) {
  std::vector<SpilledPixels> spilled;
  std::vector<std::byte> packed;
  {
    std::unique_lock lock(mutex_);
    const auto found = tiles_.find(number);
    if (found == tiles_.end()) {
      pixels.clear();
    } else {
      Tile& tile = found->second;
      moved_.wait(lock, [&] { return tile.moving == 0; });
      if (!tile.pixels.empty()) {
        if (!tile.closed) idle_.erase(tile.place);
        --in_memory_;
      }
      pixels = std::move(tile.pixels);
      packed = std::move(tile.packed);
      packed_bytes_ -= packed.size();
      spilled = std::move(tile.spilled);
      tile.spilled.clear();
      tile.packed.clear();
      tile.pixels.clear();
      // A closed one stays so: a thread that comes late to one of its pixels must find it.
      if (!tile.closed) tiles_.erase(number);
    }
  }
  if (pixels.empty()) pixels.assign(tile_floats(), kNothing);
  if (!packed.empty()) add_pixels(packed, {"pixels in memory"}, pixels);
  for (const SpilledPixels& stored : spilled) {
    std::vector<std::byte> bytes(stored.bytes);
    file_->read(stored.offset, bytes);
    add_pixels(bytes, {file_->name(), at_byte(stored.offset)}, pixels);
  }
}

void RasterStore::take(std::uint64_t number, std::vector<float>& pixels,
                       std::span<const std::vector<std::byte>> others) {
  take_as_it_is(number, pixels);
  for (const std::vector<std::byte>& stored : others) {
    add_pixels(stored, {"pixels from another rank"}, pixels);
  }
  for (std::size_t b = 0; b < bands_.size(); ++b) {
    if (bands_[b] != PixelRule::kPreferred) continue;
    for (float& pixel : std::span(pixels).subspan(b * kTilePixels, kTilePixels)) {
      pixel = as_preferred(pixel);
    }
  }
}

void RasterStore::put_back(std::uint64_t number, std::vector<float>& pixels) {
  const std::vector<Run> runs = runs_of(pixels);
  if (runs.empty()) return;
  {
    const std::lock_guard lock(mutex_);
    if (has_room()) {
      Tile& tile = tiles_[number];
      tile.pixels = std::exchange(pixels, {});
      tile.closed = true;
      ++in_memory_;
      return;
    }
  }
  append_encoded(number, encode(pixels, runs));
}

std::vector<std::byte> RasterStore::take_tile(std::uint64_t number) {
  std::vector<float> pixels;
  take_as_it_is(number, pixels);
  return encode(pixels, runs_of(pixels));
}

std::vector<std::uint64_t> RasterStore::tiles() const {
  std::vector<std::uint64_t> numbers;
  {
    const std::lock_guard lock(mutex_);
    for (const auto& [number, tile] : tiles_) {
      if (!is_taken(tile)) numbers.push_back(number);
    }
  }
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

/// Adds encoded pixels to a tile.
void RasterStore::add_pixels(std::span<const std::byte> stored, const FileSpot& where,
                             std::vector<float>& pixels) const {
  const BlockHead head = decode_block_head(stored.first<kBlockHeadSize>(), where);
  std::vector<std::byte> content;
  decode_block(head, stored.subspan(kBlockHeadSize), content, where);
  const auto count = load<std::uint32_t>(content.data());
  const std::byte* run = content.data() + sizeof(count);
  const std::byte* const column = run + count * sizeof(Run);
  std::size_t values = 0;
  for (std::uint32_t r = 0; r < count; ++r) values += load<Run>(run + r * sizeof(Run)).length;
  std::vector<std::uint32_t> ordinals;
  ColumnReader({column, content.data() + content.size()}, where).read(values, ordinals);
  auto ordinal = ordinals.begin();
  for (std::uint32_t r = 0; r < count; ++r, run += sizeof(Run)) {
    const auto [begin, length] = load<Run>(run);
    for (std::uint32_t i = begin; i < begin + length; ++i) {
      pixels[i] = combined(pixels[i], of_ordinal(*ordinal++), bands_[i / kTilePixels]);
    }
  }
}

void RasterStore::save(StateWriter& state) {
  state.section("raster");
  state.file(file_);
  auto count = static_cast<std::uint64_t>(
      std::ranges::count_if(tiles_, [](const auto& one) { return !is_taken(one.second); }));
  state(closed_tiles_, count);
  for (const auto& [number, tile] : tiles_) {
    if (is_taken(tile)) continue;
    SavedTile saved{number, tile.decided, tile.closed, tile.packed, tile.spilled};
    if (!tile.pixels.empty()) saved.packed = encode(tile.pixels, runs_of(tile.pixels));
    state(saved);
  }
}

void RasterStore::restore(StateReader& state) {
  state.section("raster");
  state.file(file_);
  std::uint64_t count = 0;
  state(closed_tiles_, count);
  for (; count > 0; --count) {
    SavedTile saved;
    state(saved);
    take_back(std::move(saved), {state.name()});
  }
}

/// Closed tiles stay packed.
void RasterStore::take_back(SavedTile saved, const FileSpot& where) {
  Tile& tile = tiles_[saved.number];
  tile.decided = saved.decided;
  tile.closed = saved.closed;
  tile.spilled = std::move(saved.spilled);
  if (saved.packed.empty()) return;
  if (tile.closed) {
    packed_bytes_ += saved.packed.size();
    packed_.push_back(saved.number);
    tile.packed = std::move(saved.packed);
  } else {
    ++in_memory_;
    tile.pixels.assign(tile_floats(), kNothing);
    add_pixels(saved.packed, where, tile.pixels);
    tile.place = idle_.insert(idle_.end(), saved.number);
  }
}

std::uint64_t RasterStore::closed_tiles() const {
  const std::lock_guard lock(mutex_);
  return closed_tiles_;
}

std::uint64_t RasterStore::spilled_bytes() const {
  const std::lock_guard lock(file_mutex_);
  return file_ ? file_->size() : 0;
}

}  // namespace spillway::stream
