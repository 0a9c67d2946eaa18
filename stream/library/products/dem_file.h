#pragma once

#include <spillway/dem.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "formats/disk/scratch_folder.h"
#include "formats/gdal/polygon_layer.h"
#include "formats/gdal/raster.h"
#include "stream/library/meshes/engine_sink.h"
#include "stream/library/tiling/raster_tiling.h"
#include "stream/sinks/dem.h"
#include "stream/sinks/dem_writer.h"

namespace spillway::stream {

/// A raster of a terrain in the making, which becomes a GeoTIFF, or stays in memory.
class DemFile final : public OwnSink<DemSink> {
 public:
  DemFile(const std::string& path, const DemOptions& options, const Context& context);
  /// `pixels` must outlive it.
  DemFile(DemPixels& pixels, const DemOptions& options, const Context& context);

  void identify(RunIdentity& identity) const override;
  [[nodiscard]] bool goes_on() const override { return true; }
  [[nodiscard]] const DemReport& report() const override { return report_; }

  [[nodiscard]] CrsNeed crs_need() const override { return CrsNeed::kAll; }
  [[nodiscard]] std::uint64_t own_memory(std::uint64_t limit) const override;
  [[nodiscard]] unsigned feeding_threads(unsigned threads) const override;
  [[nodiscard]] bool wants_extent() const override;
  void extent_known(const Box<2>& extent, std::uint64_t vertices) override;
  [[nodiscard]] bool extent_told(const Box<2>& extent, std::uint64_t vertices) override;
  [[nodiscard]] bool extent_holds(const Box<2>& extent) override;
  BlockSink* begin_again() override;
  [[nodiscard]] bool wants_simplices() const override;
  [[nodiscard]] bool wants_points() const override { return are_of_points(options_.products); }
  void take_points(std::span<const LatticePoint> points) override { dem_->take_points(points); }
  [[nodiscard]] bool has_shares() const override { return true; }
  void take_merged(const MergedBlock& block) override;
  void give_share(ShareSender& sender) override;
  void finalize(RunWatch& watch, Report& report, OtherShares& others) override;

 private:
  /// Of options that all rasters have.
  DemFile(const DemOptions& options, const Context& context);

  BlockSink& open(const MeshStart& start) override;

  /// Once all is found that is wrong without it: the driver there is, and the raster to be like.
  void ask_gdal();
  void check_crs(const MeshStart& start) const;
  void refuse_without_points(const MeshStart& start) const;
  [[nodiscard]] GroundScale ground() const;
  void check_latitudes(const Box<2>& extent) const;
  [[nodiscard]] PixelGrid grid_of(const Box<2>& extent) const;
  void check_size(const Box<2>& extent, std::uint64_t vertices) const;
  void tell_of_degrees();

  using Progress = std::function<void(std::uint64_t pixels)>;
  void write_sheet(std::size_t sheet, const Progress& progress, const OtherTiles& others,
                   bool while_painting);
  [[nodiscard]] std::uint64_t check_early_files() const;
  [[nodiscard]] std::vector<std::string> written_files() const;
  [[nodiscard]] std::vector<SheetPlace> lay_tiles(const PixelGrid& raster);
  void write_vrt(const std::vector<std::string>& files);

  std::string path_;             ///< empty: pixels_ takes them; of tiles, a pattern
  DemPixels* pixels_ = nullptr;  ///< or none
  DemOptions options_;
  RasterGrid like_;
  DemSinkOptions dem_options_;
  std::shared_ptr<ScratchFolder> scratch_;
  std::string crs_;
  bool told_of_degrees_ = false;
  std::unique_ptr<RasterTiling> tiling_;  ///< or null
  std::optional<PolygonLayer> clip_;      ///< what pixels are clipped by
  std::vector<RasterTile> tiles_;         ///< of the raster that is begun
  std::optional<Dem> dem_;
  std::optional<DemWriter> writer_;
  DemReport report_;
};

}  // namespace spillway::stream
