#pragma once
// The heights of points, sorted by the pixels that they lie in: more of them than memory holds.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "formats/disk/scratch_folder.h"

namespace spillway::formats {
class StateReader;
class StateWriter;
}  // namespace spillway::formats

namespace spillway::stream {

/// A point as far as its pixel needs it.
struct PointInPixel {
  std::uint64_t pixel = 0;  ///< the tile's number times PixelPoints::kTilePixels, and that in it
  double z = 0;

  // NOLINTNEXTLINE(modernize-use-nullptr): a false finding in what the compiler generates
  auto operator<=>(const PointInPixel&) const = default;  // NOLINT(modernize-use-nullptr)
};

/// Sorts points by pixel and height, by an external merge sort (D. Knuth, "The Art of Computer
/// Programming" 3, 5.4): what memory holds is sorted and becomes a run, and kMostRuns runs of one
/// level are merged into one of the next. What comes out depends on the set of points alone. A
/// pixel may have any number of points, and of the raster only pixels with points take anything.
class PixelPoints {
 public:
  static constexpr std::uint64_t kTilePixels = std::uint64_t{256} * 256;

  /// The least memory that it takes, in bytes.
  static constexpr std::uint64_t kLeastMemory = std::uint64_t{3} << 20;

  PixelPoints(std::uint64_t memory, ScratchFolder& scratch);
  ~PixelPoints();

  /// By many threads at once. Heights are finite.
  void add(std::span<const PointInPixel> points);

  /// After the last add(): calls `take` for each point of a tile of pixels, by pixel and from the
  /// lowest one up. Fastest tile by tile in ascending order. By one thread at a time.
  void read(std::uint64_t tile, const std::function<void(const PointInPixel&)>& take);

  /// Likewise all points.
  void read_all(const std::function<void(const PointInPixel&)>& take);

  [[nodiscard]] std::uint64_t spilled_bytes() const;

  /// For another process to go on; and on from there, in a new one. While nobody adds.
  void save(StateWriter& state);
  void restore(StateReader& state);

 private:
  /// Some points of a run, encoded.
  struct Block {
    std::uint64_t first_pixel = 0;
    std::uint64_t offset = 0;
    std::uint32_t bytes = 0;
    std::uint32_t points = 0;
  };
  /// Sorted points in a file of their own.
  struct Run {
    std::uint32_t level = 0;
    std::vector<Block> blocks;
    std::shared_ptr<ScratchFile> file;
  };
  class Writer;
  class Cursor;
  class Merge;

  void add_run(std::vector<PointInPixel>& points);
  void merge_runs();
  void begin_reading();

  ScratchFolder& scratch_;
  const std::size_t capacity_;
  std::mutex mutex_;                   ///< guards the next one
  std::vector<PointInPixel> waiting_;  ///< not sorted before all have come
  mutable std::mutex runs_mutex_;      ///< guards the next two; taken with mutex_ or without
  std::vector<Run> runs_;              ///< levels descend
  std::uint64_t spilled_ = 0;
  std::unique_ptr<Merge> merge_;  ///< of all, once they are read
};

}  // namespace spillway::stream
