#pragma once
// Bands of a raster that tell of the points in its pixels.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "formats/disk/scratch_folder.h"
#include "src/geometry/lattice.h"
#include "src/terrain/height_statistics.h"
#include "stream/sinks/dem_sink_options.h"
#include "stream/sinks/pixel_points.h"

namespace spillway::stream {

/// Any number of ascending heights, of which all but a few MiB lie on the disk.
class AscendingHeights {
 public:
  explicit AscendingHeights(ScratchFolder& scratch) : scratch_(scratch) {}

  void add(double z);
  [[nodiscard]] double at(std::uint64_t rank) const;
  void clear();

 private:
  ScratchFolder& scratch_;
  std::unique_ptr<ScratchFile> file_;
  std::uint64_t on_disk_ = 0;
  std::vector<double> latest_;
};

/// Makes these bands, tile by tile.
class PointBands {
 public:
  /// All of them must outlive it. With `lattice` the points' heights are on it.
  PointBands(const DemSinkOptions& options, PixelPoints& points,
             const std::optional<IntegerLattice>& lattice, ScratchFolder& scratch);

  /// Sets the pixels of a tile in all bands of points, not-a-number where there are none. Of all
  /// bands of the tile others are left as they are. By one thread at a time.
  void make(std::uint64_t tile, std::span<float> bands);

  /// Points that have been in a pixel, and pixels that have had some.
  [[nodiscard]] std::uint64_t points() const { return points_in_pixels_; }
  [[nodiscard]] std::uint64_t pixels() const { return pixels_with_points_; }

 private:
  struct Band {
    DemProduct product;
    std::size_t band;
    double percent;
  };
  void put(std::uint64_t pixel, std::span<float> bands);
  [[nodiscard]] double value_of(const Band& band) const;

  PixelPoints& points_;
  const std::optional<IntegerLattice> lattice_;
  std::vector<Band> made_;
  bool keeps_heights_ = false;  ///< all of a pixel are needed
  AscendingHeights heights_;    ///< of a pixel
  HeightStatistics statistics_;
  std::uint64_t points_in_pixels_ = 0;
  std::uint64_t pixels_with_points_ = 0;
};

}  // namespace spillway::stream
