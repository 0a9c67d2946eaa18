#pragma once
// Rasters of a triangulated terrain, made while its triangles pass by.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "formats/gdal/raster.h"
#include "src/geometry/box.h"
#include "src/geometry/framed_point.h"
#include "src/geometry/lattice.h"
#include "src/terrain/pixel_cells.h"
#include "src/terrain/pixel_centres.h"
#include "src/terrain/pixel_values.h"
#include "stream/sinks/dem_output.h"
#include "stream/sinks/dem_sink_options.h"
#include "stream/sinks/pixel_points.h"
#include "stream/sinks/raster_sheets.h"
#include "stream/sinks/raster_store.h"

namespace spillway::stream {

/// The raster while it is made. Every pixel is a function of the triangles at its centre, so that
/// neither their order nor threads matter.
class Dem {
 public:
  /// `lattice` is that of the vertices to come. Throws InvalidArgument if the memory is too small.
  Dem(DemSinkOptions options, const std::optional<IntegerLattice>& lattice, ScratchFolder& scratch);

  /// Lays the grid, given the box around all vertices (as they come, on the lattice if there is
  /// one). To be called before what follows; called again, what was painted is forgotten. Throws
  /// InvalidArgument if the raster is too large.
  void begin(const Box<2>& extent);
  /// Likewise, with a grid that was chosen elsewhere.
  void begin(const PixelGrid& grid);

  /// A box around vertices as they come, in output coordinates.
  [[nodiscard]] Box<2> in_output(const Box<2>& extent) const;

  /// Vertices as they come, in the coordinates in which triangles are painted.
  [[nodiscard]] std::vector<PlacedPoint> placed(std::span<const LatticePoint> vertices) const;

  /// Paints triangles, three numbers of vertices each. By any number of threads at once, and shared
  /// out among more.
  void paint(std::span<const PlacedPoint> vertices, std::span<const std::uint32_t> corners);

  /// Counts vertices for the density. By any number of threads at once.
  void count(std::span<const PlacedPoint> vertices);

  /// Takes points as they come, for products of points. By any number of threads at once.
  void take_points(std::span<const LatticePoint> points);

  [[nodiscard]] const PixelGrid& grid() const { return sheets_.raster(); }
  [[nodiscard]] const RasterSheets& sheets() const { return sheets_; }
  [[nodiscard]] RasterOptions raster_options(std::size_t sheet = 0) const;

  /// Writes all tiles of a sheet, row by row, and forgets them. `progress` is told how many of its
  /// pixels are written: a pixel with all its bands counts once. Of other Dems of the same grid,
  /// which have painted other triangles, `others` gives what they have. Less memory is taken
  /// while others are painted.
  SheetContent write(Raster& raster, const std::function<void(std::uint64_t pixels)>& progress,
                     const OtherTiles& others = nullptr, std::size_t sheet = 0,
                     bool while_painting = false);
  /// Whether write() has been called for it, here or before the Dem was saved.
  [[nodiscard]] bool is_written(std::size_t sheet) const { return states_[sheet].written; }
  /// What a sheet has that is written.
  [[nodiscard]] const SheetContent& content(std::size_t sheet) const {
    return states_[sheet].content;
  }

  /// The points that have come, as they lie in pixels; null if no product is of points. Those that
  /// another Dem of the same grid has taken may be added before write().
  [[nodiscard]] PixelPoints* points() { return points_ ? &*points_ : nullptr; }

  /// For another Dem of the same grid: the tiles that are not empty, in ascending order, and one of
  /// them, which is forgotten.
  [[nodiscard]] std::vector<std::uint64_t> tiles() const { return store_->tiles(); }
  std::vector<std::byte> take_tile(std::uint64_t tile) { return store_->take_tile(tile); }

  /// For another process to go on with the raster, begun or not; and on from there, in a Dem of the
  /// same options. While nobody paints.
  void save(StateWriter& state);
  void restore(StateReader& state);

  /// Pixels of the first band that have a value, in all sheets that are written.
  [[nodiscard]] std::uint64_t pixels_with_data() const;
  /// Triangles with too long an edge.
  [[nodiscard]] std::uint64_t left_out() const { return left_out_; }
  [[nodiscard]] std::uint64_t spilled_bytes() const;
  /// Points in pixels, pixels that have some, and pixels without that were filled; after write().
  [[nodiscard]] std::uint64_t points_in_pixels() const { return points_in_pixels_; }
  [[nodiscard]] std::uint64_t pixels_with_points() const { return pixels_with_points_; }
  [[nodiscard]] std::uint64_t filled_pixels() const { return filled_pixels_; }
  /// Tiles that were closed before write().
  [[nodiscard]] std::uint64_t closed_tiles() const { return store_->closed_tiles(); }

 private:
  struct Work;
  struct SheetState {
    std::atomic<std::uint64_t> closed = 0;  ///< its stored tiles
    std::atomic<bool> written = false;
    SheetContent content{};
  };

  [[nodiscard]] PlacedPoint placed(const LatticePoint& vertex) const;
  [[nodiscard]] Triangle in_output(const Triangle& placed) const;
  void paint_pixels(const Triangle& canonical, const PixelWindow& window, Work& work);
  [[nodiscard]] Gradient on_ground(const TrianglePlane& plane, const Triangle& canonical) const;
  void paint_run(const PixelRun& run, const TrianglePlane& plane, Work& work);
  void paint_sheet(const TileLayout& tiles, PixelRun run, const TrianglePlane& plane, Work& work);
  void paint_ring(const TileLayout& tiles, PixelRun& run, const TrianglePlane& plane, Work& work);
  void paint_large(const Triangle& canonical, const PixelWindow& whole);
  [[nodiscard]] bool closes_tiles() const;
  [[nodiscard]] std::uint64_t point_memory(std::uint64_t index) const;
  [[nodiscard]] bool heights_on_lattice() const;
  [[nodiscard]] bool writes_early() const { return closes_tiles() && options_.sheet_is_final; }
  void note_closed(std::uint64_t stored_tile);
  void hand_on_final_sheets();

  const DemSinkOptions options_;
  const std::vector<DemProduct> layers_;  ///< what is painted
  const std::optional<IntegerLattice> lattice_;
  const bool on_lattice_;  ///< triangles are painted on it
  const bool of_points_;   ///< a product is
  const Point<3> light_direction_;
  ScratchFolder& scratch_;
  RasterSheets sheets_;
  std::vector<SheetState> states_;
  std::mutex final_mutex_;
  std::deque<std::size_t> final_;  ///< sheets, not written yet; guarded by final_mutex_
  bool is_handing_on_ = false;     ///< likewise
  std::optional<PixelCentres> centres_;
  std::optional<PixelCells> cells_;
  std::optional<RasterStore> store_;
  std::optional<PixelPoints> points_;
  std::uint64_t points_in_pixels_ = 0;
  std::uint64_t pixels_with_points_ = 0;
  std::uint64_t filled_pixels_ = 0;
  std::atomic<std::uint64_t> left_out_ = 0;
};

}  // namespace spillway::stream
