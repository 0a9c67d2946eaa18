#include <spillway/density.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>

#include "formats/bytes/bytes.h"
#include "formats/disk/file_system.h"
#include "formats/disk/output_check.h"
#include "formats/gdal/gdal.h"
#include "formats/meshes/mesh_formats.h"
#include "formats/meshes/spool/mesh_spool.h"
#include "formats/points/create_points.h"
#include "formats/points/npy/npy_format.h"
#include "formats/points/npy/npy_header.h"
#include "formats/rasters/raster_file.h"
#include "formats/rasters/raster_formats.h"
#include "src/error.h"
#include "src/runtime/memory_budget.h"
#include "stream/density/density_blocks.h"
#include "stream/density/density_grid.h"
#include "stream/library/context/context_state.h"
#include "stream/library/meshes/engine_sink.h"
#include "stream/library/meshes/mesh_file.h"

namespace spillway::stream {
namespace {

/// What a density is written to.
class DensityOutput {
 public:
  virtual ~DensityOutput() = default;
  /// Where blocks with densities go, of a mesh with that header.
  virtual BlockSink& begin(const MeshStart& start) = 0;
  /// `extent` is that of the vertices.
  virtual void complete(RunWatch& watch, Report& report, const Box<3>& extent) = 0;
};

/// A mesh whose vertices carry densities.
class DensityMesh final : public DensityOutput {
 public:
  DensityMesh(const std::string& path, const Context& context)
      : file_(path, {.attributes = std::vector<std::string>{kDensity}}, context) {}

  BlockSink& begin(const MeshStart& start) override {
    file_.check_attributes(start.header.attributes);
    return file_.start(start);
  }
  void complete(RunWatch& watch, Report& report, const Box<3>& /*extent*/) override {
    file_.complete(watch, report);
  }

 private:
  MeshFile file_;
};

/// A table of vertices.
class DensityTable final : public DensityOutput, private BlockSink {
 public:
  DensityTable(std::string path, std::shared_ptr<ScratchFolder> scratch)
      : path_(std::move(path)), scratch_(std::move(scratch)) {}

  BlockSink& begin(const MeshStart& start) override {
    PointWriterOptions options;
    options.format = kNpyPoints.name;
    options.coordinates = start.header.dimension == 2 && !start.has_heights ? 2 : 3;
    options.attributes = start.header.attributes;
    options.scratch = scratch_.get();
    lattice_ = start.header.lattice;
    writer_ = open_point_writer(disk(), path_, options);
    return *this;
  }
  void complete(RunWatch& watch, Report& report, const Box<3>& /*extent*/) override {
    watch.begin("write", "points");
    writer_->finish();
    report.output_format = kNpyPoints.name;
    report.write_seconds = watch.end(report.mesh.vertices);
  }

 private:
  void write(MeshStreamBlock&& block) override {
    std::vector<LatticePoint> points;
    points.reserve(block.vertices.size());
    for (const LatticePoint& vertex : block.vertices) {
      points.emplace_back(in_world(lattice_, vertex).numbers());
    }
    writer_->write(points, block.attributes);
  }
  void finish(const MeshTotals& /*totals*/) override {}

  const std::string path_;
  std::shared_ptr<ScratchFolder> scratch_;
  std::optional<IntegerLattice> lattice_;
  std::unique_ptr<PointWriter> writer_;
};

/// A grid of any dimension as an npy array.
void write_array(const std::string& path, const DensityGrid& grid, int dimension) {
  NpyHeader header{.type = "<f8", .shape = {}};
  for (int k = 0; k < dimension; ++k) header.shape.push_back(grid.shape().cells[k]);
  const auto file = disk().create(path);
  file->write(as_bytes_of(npy_header_bytes(header, path)));
  file->write(std::as_bytes(std::span(grid.values())));
  file->commit();
}

/// A grid of the plane as a GeoTIFF, whose rows begin in the north.
void write_raster(const std::string& path, const DensityGrid& grid, const std::string& crs) {
  const GridShape& shape = grid.shape();
  RasterOptions options;
  options.name = options.path = path;
  options.bands = {kDensity};
  options.grid.crs = crs;
  options.grid.pixels = {.west = shape.box.lo[0],
                         .north = shape.box.hi[1],
                         .resolution = shape.step(0),
                         .columns = shape.cells[0],
                         .rows = shape.cells[1]};
  RasterFile file(options);
  std::vector<float> tile(std::size_t{kRasterTile} * kRasterTile);
  for (std::uint32_t top = 0; top < shape.cells[1]; top += kRasterTile) {
    for (std::uint32_t left = 0; left < shape.cells[0]; left += kRasterTile) {
      std::fill(tile.begin(), tile.end(), options.nodata);
      for (std::uint32_t row = top; row < std::min(top + kRasterTile, shape.cells[1]); ++row) {
        for (std::uint32_t column = left; column < std::min(left + kRasterTile, shape.cells[0]);
             ++column) {
          const std::size_t y = shape.cells[1] - 1 - row;
          const double value = grid.values()[std::size_t{column} * shape.cells[1] + y];
          if (std::isnan(value)) continue;
          tile[(row - top) * std::size_t{kRasterTile} + column - left] = static_cast<float>(value);
        }
      }
      file.raster().write_tile(0, left / kRasterTile, top / kRasterTile, tile);
    }
  }
  file.finish();
}

/// A grid, painted when it is known where it lies.
class DensityRaster final : public DensityOutput {
 public:
  DensityRaster(std::string path, const DensityOptions& options,
                std::shared_ptr<ScratchFolder> scratch, MemoryBudget& budget)
      : path_(std::move(path)),
        is_geotiff_(kGeoTiff.is_named(path_)),
        options_(options),
        scratch_(std::move(scratch)),
        budget_(budget) {}

  BlockSink& begin(const MeshStart& start) override {
    header_ = start.header;
    const bool flat = header_.dimension == 2;
    if (is_geotiff_ && !flat) {
      throw InvalidArgument("GeoTIFF holds rasters of the plane: write a grid in space as npy",
                            {.file = path_});
    }
    for (int k = 0; k < header_.dimension; ++k) {
      if (options_.cells[k] == 0) {
        throw InvalidArgument(
            fmt::format("the grid has no cells along {}: give a number for each axis", "xyz"[k]));
      }
    }
    if (options_.grid_box) check(*options_.grid_box);
    grid_.reset();
    spool_.reset();
    memory_ = {};
    double bytes = sizeof(double);
    for (int k = 0; k < header_.dimension; ++k) bytes *= options_.cells[k];
    if (bytes > static_cast<double>(budget_.limit())) {
      throw InvalidArgument(
          fmt::format("a grid of {:.3g} cells takes more than a quarter of the memory, {}: choose "
                      "fewer cells, or a larger limit",
                      bytes / sizeof(double), memory_size_text(budget_.limit())),
          {.remedy = Remedy::kMemory});
    }
    memory_ = MemoryLease(budget_, static_cast<std::uint64_t>(bytes), "the grid of densities");
    if (const std::optional<Box<3>> box = known_box()) return make_grid(*box);
    return spool_.emplace(header_, path_, *scratch_);
  }

  void complete(RunWatch& watch, Report& report, const Box<3>& extent) override {
    watch.begin("write", "cells");
    if (spool_) {
      spool_->finish(report.mesh);
      make_grid(box_around(extent));
      MeshStreamBlock block;
      const auto reader = spool_->open();
      while (reader->read(block)) {
        watch.check();
        grid_->write(std::move(block));
      }
    }
    if (is_geotiff_) {
      write_raster(path_, *grid_, header_.crs);
    } else {
      write_array(path_, *grid_, header_.dimension);
    }
    report.output_format = is_geotiff_ ? "tif" : "npy";
    report.write_seconds = watch.end(grid_->shape().count());
  }

 private:
  void check(const Extent& box) const {
    for (int k = 0; k < header_.dimension; ++k) {
      if (std::isfinite(box.high[k] - box.low[k]) && box.low[k] < box.high[k]) continue;
      throw InvalidArgument(
          fmt::format("the box of the grid has no length along {}: it goes from "
                      "{} to {}",
                      "xyz"[k], box.low[k], box.high[k]));
    }
  }

  [[nodiscard]] std::optional<Box<3>> known_box() const {
    if (options_.grid_box) return Box<3>{options_.grid_box->low, options_.grid_box->high};
    for (int k = 0; k < header_.dimension; ++k) {
      if (!header_.periodic || !header_.periodic->periodic[k]) return std::nullopt;
    }
    return box_around({});
  }

  [[nodiscard]] Box<3> box_around(const Box<3>& extent) const {
    Box<3> box = extent;
    for (int k = 0; k < header_.dimension; ++k) {
      if (!header_.periodic || !header_.periodic->periodic[k]) continue;
      box.lo[k] = header_.periodic->box.low[k];
      box.hi[k] = header_.periodic->box.high[k];
    }
    return box;
  }

  DensityGrid& make_grid(const Box<3>& box) {
    GridShape shape;
    shape.box = box;
    for (int k = 0; k < header_.dimension; ++k) {
      shape.cells[k] = options_.cells[k];
      if (!(box.lo[k] < box.hi[k])) {
        throw InvalidArgument(fmt::format("the grid has no length along {}", "xyz"[k]));
      }
    }
    const bool may_grow = !options_.grid_box && !header_.periodic;
    if (is_geotiff_ && may_grow) {
      // To the east or to the north, so that pixels are squares.
      const double side = std::max(shape.step(0), shape.step(1));
      for (int k = 0; k < 2; ++k) shape.box.hi[k] = box.lo[k] + side * shape.cells[k];
    }
    const double step = shape.step(0);
    if (is_geotiff_ && std::abs(shape.step(1) - step) > 1e-9 * step) {
      throw InvalidArgument(
          fmt::format(
              "pixels of a GeoTIFF are squares, and cells of this grid are {} by {}: choose "
              "cells or a box that make them so",
              step, shape.step(1)),
          {.file = path_});
    }
    return grid_.emplace(header_, shape);
  }

  const std::string path_;
  const bool is_geotiff_;
  const DensityOptions options_;
  std::shared_ptr<ScratchFolder> scratch_;
  MemoryBudget& budget_;
  MemoryLease memory_;
  MeshStreamHeader header_;
  std::optional<DensityGrid> grid_;
  std::optional<MeshSpool> spool_;
};

class DensityFile final : public OwnSink<DensitySink> {
 public:
  DensityFile(const std::string& path, const DensityOptions& options, const Context& context)
      : OwnSink(context),
        path_(path),
        options_(options),
        scratch_(context.state().scratch(context)),
        budget_(own_memory(context.memory()), context.memory()) {
    if (path == "-") throw InvalidArgument("densities go to a file: name one");
    has_grid_ = options.cells != std::array<std::uint32_t, 3>{};
    const bool is_npy = point_format_of_path(path) == &kNpyPoints;
    if (has_grid_ ? !is_npy && !kGeoTiff.is_named(path)
                  : !is_npy && mesh_format_of_extension(path) == nullptr) {
      throw InvalidArgument(
          fmt::format("{} cannot be written: {}", path,
                      has_grid_ ? "a grid of densities is npy or GeoTIFF (.tif)"
                                : "densities of vertices are npy or a mesh (vtu, spm, ply)"),
          {.file = path});
    }
    if (!has_grid_ && options.grid_box) {
      throw InvalidArgument("a box of a grid has no effect without cells of it");
    }
    check_can_create(path);
  }

  [[nodiscard]] DensityTotals totals() const override { return totals_; }

  [[nodiscard]] std::uint64_t own_memory(std::uint64_t limit) const override { return limit / 4; }
  [[nodiscard]] AttributeChoice wanted_attributes(bool /*triangulated*/) const override {
    AttributeChoice choice;
    if (!options_.weight.empty()) choice.names = {options_.weight};
    return choice;
  }
  void check_attributes(const AttributeLayout& there) const override {
    if (!options_.weight.empty() && there.find(options_.weight) == nullptr) {
      throw unknown_attribute(options_.weight, there.attributes());
    }
  }
  void check_periodic(int /*dimension*/) const override {}
  [[nodiscard]] bool can_begin_again() const override { return true; }
  BlockSink* begin_again() override {
    blocks_.reset();
    output_ = make_output();
    MeshStart start = start_;
    start.header = with_density(std::move(start.header));
    return &blocks_.emplace(output_->begin(start), start_.header, options_.weight, budget_);
  }
  void identify(RunIdentity& identity) const override {
    identify_product("density", path_, identity);
  }
  void finalize(RunWatch& watch, Report& report, OtherShares& /*others*/) override {
    blocks_->finish(report.mesh);
    totals_ = blocks_->totals();
    output_->complete(watch, report, blocks_->extent());
  }

 private:
  BlockSink& open(const MeshStart& start) override {
    if (start.header.dimension > 3) {
      throw InvalidArgument(
          fmt::format("densities are made in 2 and 3 dimensions, not {}", start.header.dimension));
    }
    start_ = start;
    return *begin_again();
  }

  [[nodiscard]] std::unique_ptr<DensityOutput> make_output() {
    if (has_grid_) return std::make_unique<DensityRaster>(path_, options_, scratch_, budget_);
    if (point_format_of_path(path_) == &kNpyPoints)
      return std::make_unique<DensityTable>(path_, scratch_);
    return std::make_unique<DensityMesh>(path_, context());
  }

  const std::string path_;
  const DensityOptions options_;
  bool has_grid_ = false;
  std::shared_ptr<ScratchFolder> scratch_;
  MemoryBudget budget_;
  MeshStart start_;
  std::unique_ptr<DensityOutput> output_;
  std::optional<DensityBlocks> blocks_;
  DensityTotals totals_;
};

}  // namespace
}  // namespace spillway::stream

namespace spillway {

std::unique_ptr<DensitySink> create_density(const std::string& path, const DensityOptions& options,
                                            const Context& context) {
  return std::make_unique<stream::DensityFile>(path, options, context);
}

}  // namespace spillway
