#pragma once
// The pixels of a raster that may be larger than the memory.

#include <array>
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "formats/disk/scratch_folder.h"
#include "src/error.h"

namespace spillway::formats {
class StateReader;
class StateWriter;
}  // namespace spillway::formats

namespace spillway::stream {

/// What is in a pixel of one band. Nothing is not-a-number. All else is put there by put_pixel(),
/// and what comes out in the end does not depend on the order.
enum class PixelRule : std::uint8_t {
  kEqual,      ///< whatever is put there is equal
  kPreferred,  ///< values from 0 (-0 is 0); the preferred one if there is one, else the smallest
  kSum,        ///< all of them added; whole numbers, 2^24 at most
};

/// Puts a value into a pixel; so may other threads at the same time.
void put_pixel(float& pixel, float value, PixelRule rule, bool preferred);

/// The same for kEqual.
inline void set_pixel(float& pixel, float value) {
  std::atomic_ref<float>(pixel).store(value, std::memory_order_relaxed);
}

/// A raster in tiles of kSide x kSide pixels, each with all bands. A tile is closed when all of its
/// pixels are decided, where that can be told: nothing is put there any more. When tiles take too
/// much memory, closed ones are packed, and then go to the disk. If there are none, those that have
/// not been used for the longest time go there, with the pixels that they have so far; used again,
/// they begin empty, and all pixels are put together at the end. So nothing is read back before,
/// and a pixel is written once as a rule.
class RasterStore {
 public:
  static constexpr std::uint32_t kSide = 256;
  static constexpr std::size_t kTilePixels = std::size_t{kSide} * kSide;

  /// Tiles that one thread holds at a time.
  static constexpr std::size_t kTilesInHand = 4;

  /// How many pixels of a tile are to be decided. By any thread.
  using PixelsOfTile = std::function<std::uint32_t(std::uint64_t number)>;

  /// Told of a tile that is closed, by the thread that had it in hand last. Must not throw.
  using TileClosed = std::function<void(std::uint64_t number)>;

  /// Tiles that fit in `memory` bytes are kept; those in hands are, in any case. Without `wanted`
  /// no tile is closed.
  RasterStore(std::vector<PixelRule> bands, std::uint64_t memory, ScratchFolder& scratch,
              PixelsOfTile wanted = nullptr, TileClosed told = nullptr);

  /// The least memory that gives `threads` threads a hand and the store some room.
  static std::uint64_t least_memory(std::size_t bands, unsigned threads);

  /// A few tiles that stay in memory while one thread writes to them.
  class Hand {
   public:
    explicit Hand(RasterStore& store) : store_(store) {}
    ~Hand() { release(); }
    Hand(const Hand&) = delete;
    Hand& operator=(const Hand&) = delete;

    /// The pixels of a tile, row by row, band after band, until kTilesInHand others are asked for.
    /// Null if it is closed.
    float* tile(std::uint64_t number) {
      for (Held& held : held_) {
        if (held.pixels == nullptr || held.number != number) continue;
        latest_ = &held;
        return held.pixels;
      }
      return take_up(number);
    }

    /// So many pixels of the tile that was asked for last have got their final value, in all bands.
    /// To be told once of each pixel.
    void decide(std::uint32_t pixels) { latest_->decided += pixels; }

    void release();

   private:
    struct Held {
      std::uint64_t number = 0;
      float* pixels = nullptr;
      std::uint32_t decided = 0;  ///< pixels, here
    };
    float* take_up(std::uint64_t number);
    void let_go(Held& held);

    RasterStore& store_;
    std::array<Held, kTilesInHand> held_{};
    Held* latest_ = nullptr;
    std::size_t next_ = 0;  ///< to be let go of
  };

  /// Takes a tile out of the store, all pixels put together, also `others`, which take_tile() of
  /// stores like this one has given; nothing but not-a-number if it has none. When no hand holds
  /// it, and while others may be painted. May be called by many threads.
  void take(std::uint64_t number, std::vector<float>& pixels,
            std::span<const std::vector<std::byte>> others = {});

  /// Gives back a tile that take() has given, to be taken once more; it goes to the disk if there
  /// is no room. While pixels are taken only. May be called by many threads.
  void put_back(std::uint64_t number, std::vector<float>& pixels);

  /// Takes a tile out of the store, for another one.
  std::vector<std::byte> take_tile(std::uint64_t number);

  /// The tiles that have been written to, in ascending order.
  [[nodiscard]] std::vector<std::uint64_t> tiles() const;

  [[nodiscard]] std::uint64_t spilled_bytes() const;
  [[nodiscard]] std::uint64_t closed_tiles() const;

  /// For another process to go on; and on from there, in a new store of the same bands. While no
  /// hand holds a tile.
  void save(StateWriter& state);
  void restore(StateReader& state);

 private:
  struct SpilledPixels {
    std::uint64_t offset = 0;
    std::uint32_t bytes = 0;
  };
  struct Tile {
    std::vector<float> pixels;  ///< empty while not in memory
    unsigned hands = 0;
    std::uint32_t decided = 0;  ///< pixels
    bool closed = false;
    unsigned moving = 0;  ///< threads that pack its pixels, or write them to the disk
    std::list<std::uint64_t>::iterator place;  ///< in idle_, while in memory, open and in no hand
    std::vector<std::byte> packed;             ///< of a closed tile, while in memory
    std::vector<SpilledPixels> spilled;        ///< on the disk
  };

  /// A tile as it is saved.
  struct SavedTile {
    std::uint64_t number = 0;
    std::uint32_t decided = 0;
    bool closed = false;
    std::vector<std::byte> packed;  ///< what is in memory
    std::vector<SpilledPixels> spilled;

    template <typename State>
    void state(State& state) {
      state(number, decided, closed, packed, spilled);
    }
  };

  class Move;

  static bool is_taken(const Tile& tile) {
    return tile.closed && tile.moving == 0 && tile.pixels.empty() && tile.packed.empty() &&
           tile.spilled.empty();
  }

  float* hold(std::uint64_t number);
  void let_go(std::uint64_t number, std::uint32_t decided);
  void take_back(SavedTile saved, const FileSpot& where);
  std::vector<float> empty_tile(std::unique_lock<std::mutex>& lock);
  bool make_room(std::unique_lock<std::mutex>& lock);
  void pack_closed(std::unique_lock<std::mutex>& lock);
  void write_packed(std::unique_lock<std::mutex>& lock);
  [[nodiscard]] bool has_room() const;
  [[nodiscard]] std::size_t tile_floats() const { return bands_.size() * kTilePixels; }
  [[nodiscard]] std::size_t tile_bytes() const { return tile_floats() * sizeof(float); }
  void append(std::uint64_t number, std::span<const float> pixels);
  void append_encoded(std::uint64_t number, std::span<const std::byte> block);
  void take_as_it_is(std::uint64_t number, std::vector<float>& pixels);
  void add_pixels(std::span<const std::byte> stored, const FileSpot& where,
                  std::vector<float>& pixels) const;

  const std::vector<PixelRule> bands_;
  const std::uint64_t memory_;
  ScratchFolder& scratch_;
  const PixelsOfTile wanted_;
  const TileClosed told_;
  mutable std::mutex mutex_;       ///< guards the next seven
  std::condition_variable moved_;  ///< pixels of a tile
  std::unordered_map<std::uint64_t, Tile> tiles_;
  std::list<std::uint64_t> idle_;     ///< in memory, open, in no hand; the longest unused first
  std::deque<std::uint64_t> closed_;  ///< in memory as they are, or taken meanwhile
  std::deque<std::uint64_t> packed_;  ///< in memory, or taken meanwhile
  std::size_t in_memory_ = 0;         ///< tiles as they are
  std::uint64_t packed_bytes_ = 0;
  std::uint64_t closed_tiles_ = 0;
  mutable std::mutex file_mutex_;  ///< guards file_ while it grows; taken without mutex_
  std::shared_ptr<ScratchFile> file_;
};

}  // namespace spillway::stream
