#pragma once
// What is painted of a terrain becomes the bands of a raster.

#include <spillway/choices.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "formats/gdal/raster.h"
#include "src/terrain/neighbourhood.h"
#include "stream/sinks/dem_sink_options.h"
#include "stream/sinks/point_bands.h"
#include "stream/sinks/raster_store.h"
#include "stream/sinks/tile_layout.h"

namespace spillway::stream {

/// What has to be painted for products, layer by layer: those of neighbours need heights, and so
/// does filling voids.
std::vector<DemProduct> layers_of(const std::vector<DemProduct>& products, bool fill_voids);

/// Whether a product is of points.
bool are_of_points(const std::vector<DemProduct>& products);

/// Whether a product depends on neighbours.
bool has_neighbours(const std::vector<DemProduct>& products);

/// What another raster of the same grid has of a tile; called tile by tile, in order.
using OtherTiles = std::function<std::vector<std::vector<std::byte>>(std::uint64_t tile)>;

/// What a sheet has.
struct SheetContent {
  std::uint64_t pixels_with_data = 0;  ///< of the first band
  bool is_empty = true;                ///< no pixel of any band has a value
};

/// Makes bands of layers, tile by tile. Where products depend on neighbours, tiles are taken from
/// the store a row ahead for the heights at their edges, and put back.
class DemOutput {
 public:
  /// All of them must outlive it. Pixels beside an outline get no data. It has so many tiles in
  /// work at a time.
  DemOutput(const DemSinkOptions& options, const std::vector<DemProduct>& layers,
            const TileLayout& tiles, const PolygonPixels* outline, RasterStore& store,
            std::size_t slots);

  /// The least number of tiles in work, so that one is made while another is written.
  static constexpr std::size_t kLeastSlots = 2;
  /// What a tile in work takes, in bytes.
  static std::uint64_t slot_bytes(const DemSinkOptions& options,
                                  const std::vector<DemProduct>& layers);

  /// What it needs besides tiles of pixels, in bytes.
  static std::uint64_t bytes(const TileLayout& tiles);

  /// Has these bands made, too; to be called before write() if a product is of points.
  void add_points(PointBands& points) { points_ = &points; }

  /// As Dem::write().
  SheetContent write(Raster& raster, const std::function<void(std::uint64_t pixels)>& progress,
                     const OtherTiles& others);

  /// Pixels without points that have got the height of a triangle; after write().
  [[nodiscard]] std::uint64_t filled_pixels() const { return filled_; }

 private:
  struct Slot;
  struct Derived {
    DemProduct product;
    std::size_t band;
  };

  /// Bands are just what is painted.
  [[nodiscard]] bool are_layers_bands() const { return derived_.empty() && points_ == nullptr; }
  void take_ring(const OtherTiles& others);
  void make_bands(std::uint64_t tile, Slot& slot) const;
  void add_ring(std::uint64_t tile, std::span<float> framed) const;
  void derive(std::uint64_t tile, Slot& slot) const;
  void fill_voids(std::uint64_t tile, Slot& slot) const;
  [[nodiscard]] double value_of(DemProduct product, const Neighbourhood& z, const Point<2>& sides,
                                const Gradient& gradient) const;
  void cut_out(std::uint64_t tile, std::vector<float>& bands) const;
  void finish_band(DemProduct product, TileLayout::Size size, std::span<float> band) const;

  const DemSinkOptions& options_;
  const std::vector<DemProduct>& layers_;
  const TileLayout& tiles_;
  const PolygonPixels* const outline_;
  RasterStore& store_;
  const std::size_t slots_;
  std::vector<Derived> derived_;
  std::size_t heights_ = 0;  ///< their layer, if anything is derived or filled
  PointBands* points_ = nullptr;
  std::uint64_t filled_ = 0;
  std::vector<float> ring_;  ///< heights
  const Point<3> light_direction_;
  const MultiShade multi_shade_;
};

}  // namespace spillway::stream
