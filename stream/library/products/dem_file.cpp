#include "stream/library/products/dem_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <set>
#include <span>
#include <string_view>

#include "formats/disk/output_check.h"
#include "formats/gdal/gdal.h"
#include "formats/rasters/raster_file.h"
#include "formats/rasters/raster_formats.h"
#include "src/parallel/parallel.h"
#include "src/runtime/memory_budget.h"
#include "src/terrain/grid_choice.h"
#include "stream/library/choice_check.h"
#include "stream/library/context/context_state.h"
#include "stream/library/context/executor.h"
#include "stream/library/points/clip_polygons.h"
#include "stream/library/products/pixels_in_memory.h"
#include "stream/library/products/surface_units.h"
#include "stream/plan/memory_plan.h"
#include "stream/sinks/dem_shares.h"

namespace spillway::stream {
namespace {

constexpr std::uint64_t kLeastMemory = std::uint64_t{64} << 20;
/// The part of the memory that is for pixels.
constexpr std::uint64_t kPixelShare = 4;
/// The part of that which is for overviews of tiles that are written early.
constexpr std::uint64_t kShareOfOverviews = 4;

/// A raster is large because of points far away if it has many pixels, and thousands for each
/// vertex; it may be if it has hundreds.
constexpr double kManyPixels = 1e7;
constexpr double kManyForAVertex = 100;
constexpr double kTooManyForAVertex = 2000;

double pixels_of(const PixelGrid& grid) { return static_cast<double>(grid.columns) * grid.rows; }

bool is_large(const PixelGrid& grid, std::uint64_t vertices) {
  const double pixels = pixels_of(grid);
  return pixels > kManyPixels && pixels > kManyForAVertex * static_cast<double>(vertices);
}

void check_path(const std::string& path) {
  if (!can_be_tried(path)) {
    throw InvalidArgument(
        fmt::format("{}: a GeoTIFF is not written in one go, so it needs a file", path));
  }
  if (!kGeoTiff.is_named(path)) {
    throw InvalidArgument(fmt::format("{}: a DEM is a GeoTIFF: give it a name that ends in .{}",
                                      path, kGeoTiff.extensions.front()));
  }
}

void check_products(const std::vector<DemProduct>& products) {
  if (products.empty()) throw InvalidArgument("a DEM has a product at least: none is given");
  for (const DemProduct product : products) {
    check_choice(product, DemProduct::kPercentile, "product");
  }
  std::set<DemProduct> seen;
  for (const DemProduct product : products) {
    if (product != DemProduct::kPercentile && !seen.insert(product).second) {
      throw InvalidArgument("a product is there twice");
    }
  }
}

/// Percentiles, and what is filled.
void check_products_of_points(const DemOptions& options) {
  const std::vector<double>& percentiles = options.percentiles;
  const auto wanted = std::ranges::count(options.products, DemProduct::kPercentile);
  if (std::ssize(percentiles) != wanted) {
    throw InvalidArgument(
        fmt::format("{} percentiles are among the products, and {} numbers say "
                    "which: there must be one for each",
                    wanted, percentiles.size()));
  }
  for (const double percent : percentiles) {
    if (!(percent >= 0 && percent <= 100)) {
      throw InvalidArgument(fmt::format("percentiles are of 0 to 100, not {}", percent));
    }
  }
  if (std::set<double>(percentiles.begin(), percentiles.end()).size() < percentiles.size()) {
    throw InvalidArgument("a percentile is there twice");
  }
  if (options.fill_voids && std::ranges::none_of(options.products, [](DemProduct product) {
        return traits_of(product).fills_voids;
      })) {
    throw InvalidArgument(
        "voids are filled of lowest, highest and mean heights of points, and of "
        "percentiles, none of which is among the products");
  }
}

/// Whether it depends on z.
bool is_of_heights(DemProduct product) {
  return product != DemProduct::kDensity && product != DemProduct::kCount;
}

/// Whether a product compares heights with distances.
bool is_by_ground(DemProduct product) { return traits_of(product).by_ground; }

/// Bytes hold shades.
void check_type(const DemOptions& options) {
  check_choice(options.type, PixelType::kByte, "pixel type");
  if (options.type != PixelType::kByte) return;
  for (const DemProduct product : options.products) {
    if (traits_of(product).by_altitude) continue;
    throw InvalidArgument(
        fmt::format("bytes hold shades, from 1 to 255, and not {}: choose float32",
                    dem_product_names()[static_cast<std::size_t>(product)]));
  }
}

void check_light_and_file(const DemOptions& options) {
  if (!(options.azimuth >= 0 && options.azimuth <= 360)) {
    throw InvalidArgument(
        fmt::format("light comes from 0 to 360 degrees, not from {}", options.azimuth));
  }
  if (!(options.altitude >= 0 && options.altitude <= 90)) {
    throw InvalidArgument(
        fmt::format("light stands 0 to 90 degrees above the horizon, not {}", options.altitude));
  }
  const std::array<std::string_view, 3> kinds = {"deflate", "zstd", "none"};
  if (std::ranges::find(kinds, options.compression) == kinds.end()) {
    throw InvalidArgument(fmt::format("\"{}\" is not a compression: choose {}", options.compression,
                                      fmt::join(kinds, ", ")));
  }
}

GridRequest grid_request(const DemOptions& options) {
  if (!(options.resolution > 0) || !std::isfinite(options.resolution)) {
    throw InvalidArgument(fmt::format("pixels have a side above 0, not of {}", options.resolution));
  }
  GridRequest grid{.resolution = options.resolution, .align = options.align};
  if (!options.bounds) return grid;
  const auto& [low, high] = *options.bounds;
  if (!(low[0] < high[0] && low[1] < high[1])) {
    throw InvalidArgument(fmt::format("{}, {}, {}, {} is not an area: xmin, ymin, xmax, ymax",
                                      low[0], low[1], high[0], high[1]));
  }
  grid.bounds = Box<2>{{low[0], low[1]}, {high[0], high[1]}};
  return grid;
}

RasterOptions file_options(const std::string& path, const DemOptions& options,
                           RasterOptions raster) {
  raster.name = raster.path = path;
  raster.type = options.type;
  raster.compression = options.compression;
  raster.cloud_optimized = options.cloud_optimized;
  return raster;
}

}  // namespace

DemFile::DemFile(const DemOptions& options, const Context& context)
    : OwnSink(context), options_(options), scratch_(context.state().scratch(context)) {
  check_products(options_.products);
  check_products_of_points(options_);
  check_choice(options_.gradient, GradientMethod::kZevenbergenThorne, "gradient method");
  check_light_and_file(options_);
  check_z_factor(options_.z_factor);
  check_max_edge(options_.max_edge);
  if (context.memory() < kLeastMemory) {
    throw TooSmallLimit("the memory limit is too small: 64 MiB are the least for a DEM",
                        {.enough = kLeastMemory, .remedy = Remedy::kMemory});
  }
  if (options_.like.empty()) dem_options_.grid = grid_request(options_);
  dem_options_.products = options_.products;
  dem_options_.light = {options_.azimuth, options_.altitude};
  dem_options_.gradient = options_.gradient;
  dem_options_.compute_edges = options_.compute_edges;
  dem_options_.percentiles = options_.percentiles;
  dem_options_.fill_voids = options_.fill_voids;
  dem_options_.nodata = options_.nodata;
  dem_options_.memory = own_memory(context.memory());
  dem_options_.threads = feeding_threads(context.threads());
  check_clip(options_.clip);
  if (!options_.clip.polygons.empty()) {
    if (!options_.tile_polygons.empty()) {
      throw InvalidArgument("tiles are polygons, or the raster is clipped by some, not both");
    }
    clip_ = read_clip(options_.clip);
    dem_options_.sheets = [this](const PixelGrid& raster) { return lay_tiles(raster); };
  }
}

DemFile::DemFile(const std::string& path, const DemOptions& options, const Context& context)
    : DemFile(options, context) {
  path_ = path;
  check_path(path_);
  check_type(options_);
  if (options_.type == PixelType::kByte) dem_options_.nodata = 0;
  tiling_ = make_tiling(path_, options_);
  if (tiling_) {
    dem_options_.grid.align = options_.align || options_.tile_side != 0;
    dem_options_.sheets = [this](const PixelGrid& raster) { return lay_tiles(raster); };
    dem_options_.memory_of_files =
        options_.cloud_optimized ? dem_options_.memory / kShareOfOverviews : 0;
    dem_options_.sheet_is_final = [this](std::size_t sheet) {
      write_sheet(
          sheet, [](std::uint64_t) {}, nullptr, true);
    };
    if (options_.vrt.empty()) options_.vrt = vrt_path_of(path_);
  }
  if (is_first_process(context)) {
    check_can_create(path_);
    if (tiling_) check_can_create(options_.vrt);
  }
}

DemFile::DemFile(DemPixels& pixels, const DemOptions& options, const Context& context)
    : DemFile(options, context) {
  pixels_ = &pixels;
}

std::uint64_t DemFile::own_memory(std::uint64_t limit) const { return limit / kPixelShare; }

unsigned DemFile::feeding_threads(unsigned threads) const {
  const std::uint64_t limit = context().memory();
  return threads_beside(own_memory(limit), limit, threads);
}

bool DemFile::wants_simplices() const {
  return options_.fill_voids || std::ranges::any_of(options_.products, [](DemProduct product) {
           return !traits_of(product).of_points;
         });
}

bool DemFile::wants_extent() const { return !dem_options_.grid.bounds && options_.like.empty(); }

void DemFile::ask_gdal() {
  if (pixels_ == nullptr) {
    const RasterOptions of_any_raster;
    gdal().check_raster_driver(file_options(path_, options_, of_any_raster));
  }
  if (options_.like.empty()) return;
  like_ = gdal().read_raster_grid(options_.like);
  dem_options_.grid.given = like_.pixels;
}

BlockSink& DemFile::open(const MeshStart& start) {
  refuse_tetrahedra(start);
  if (std::ranges::any_of(options_.products, is_of_heights)) refuse_without_heights(start);
  refuse_without_points(start);
  ask_gdal();
  check_crs(start);
  crs_ = start.header.crs.empty() ? like_.crs : start.header.crs;
  dem_options_.ground = ground();
  if (const auto& extent = start.header.extent) check_latitudes(plane_of(*extent));
  if (!start.is_triangulated) dem_options_.max_edge = options_.max_edge;
  // Pixels of other meshes may be painted twice, and those of ranks by others, too.
  dem_options_.closes_tiles = start.is_triangulated && context().options().executor == nullptr;
  dem_.emplace(dem_options_, start.header.lattice,
               start.scratch != nullptr ? *start.scratch : *scratch_);
  // What is too large is told before the points are read.
  if (!wants_extent()) {
    dem_->begin(Box<2>{});
    tell_of_degrees();
  }
  return writer_.emplace(*dem_);
}

/// Of a mesh only the vertices are left of the points.
void DemFile::refuse_without_points(const MeshStart& start) const {
  if (start.is_triangulated || !wants_points()) return;
  const auto found = std::ranges::find_if(
      options_.products, [](DemProduct product) { return traits_of(product).of_points; });
  throw InvalidArgument(
      fmt::format("{} is a mesh, which has only vertices, and {} is of all points: give the points",
                  start.name, dem_product_names()[static_cast<std::size_t>(*found)]));
}

/// What pixels are; how the file keeps them may be another choice.
void DemFile::identify(RunIdentity& identity) const {
  identify_product("raster", path_, identity);
  const auto add = [&](const char* name, const auto& value) {
    identity.add(name, fmt::format("{}", value));
  };
  std::vector<std::string> names;
  for (const DemProduct product : options_.products) {
    names.push_back(dem_product_names()[static_cast<std::size_t>(product)]);
  }
  identity.add("product", fmt::format("{}", fmt::join(names, ",")));
  if (options_.like.empty()) {
    add("side of a pixel", options_.resolution);
    add("bounds of the raster", options_.bounds
                                    ? fmt::format("{} to {}", fmt::join(options_.bounds->low, " "),
                                                  fmt::join(options_.bounds->high, " "))
                                    : "all points");
    add("align", options_.align);
  } else {
    identity.add_file("raster to be like", options_.like);
  }
  add("azimuth", options_.azimuth);
  add("altitude", options_.altitude);
  add("gradient", options_.gradient == GradientMethod::kHorn ? "Horn" : "Zevenbergen-Thorne");
  add("values at edges", options_.compute_edges);
  add("percentiles", fmt::format("{}", fmt::join(options_.percentiles, " ")));
  add("filled voids", options_.fill_voids);
  add("side of tiles", options_.tile_side);
  if (clip_) {
    add("clip",
        fmt::format("{}, {}", options_.clip.outside ? "outside" : "inside", options_.clip.buffer));
    identity.add_file("polygons of the clip", options_.clip.polygons);
  }
  if (!options_.tile_polygons.empty()) identity.add_file("polygons", options_.tile_polygons);
  if (tiling_) {  // some may be written
    add("nodata", dem_options_.nodata);
    add("bytes", options_.type == PixelType::kByte);
    add("compression", options_.compression);
    add("cloud optimized", options_.cloud_optimized);
  }
  add("factor of z", options_.z_factor ? fmt::format("{}", *options_.z_factor) : "by units");
}

void DemFile::extent_known(const Box<2>& extent, std::uint64_t vertices) {
  if (!wants_extent()) return;
  check_latitudes(dem_->in_output(extent));
  check_size(extent, vertices);
  dem_->begin(extent);
  tell_of_degrees();
}

/// A raster that is refused, or that a warning tells of, is so when the extent is certain.
bool DemFile::extent_told(const Box<2>& extent, std::uint64_t vertices) {
  try {
    check_latitudes(dem_->in_output(extent));
    if (is_large(grid_of(extent), vertices)) return false;
    dem_->begin(extent);
  } catch (const Failure&) {
    return false;
  }
  tell_of_degrees();
  return true;
}

bool DemFile::extent_holds(const Box<2>& extent) { return grid_of(extent) == dem_->grid(); }

BlockSink* DemFile::begin_again() {
  for (const std::string& file : written_files()) {  // of another grid
    std::error_code ignored;
    std::filesystem::remove(file, ignored);
  }
  if (!wants_extent()) dem_->begin(Box<2>{});
  return &writer_.emplace(*dem_);
}

/// Heights without a unit are in that of x and y, and in metres above degrees.
GroundScale DemFile::ground() const {
  if (!std::ranges::any_of(options_.products, is_by_ground)) return {};
  if (options_.z_factor) return {.height = *options_.z_factor};
  if (crs_.empty()) return {};
  const CrsUnits units = gdal().crs_units(crs_);
  if (units.is_geographic) {
    if (context().options().detail) {
      context().options().detail(fmt::format(
          "{}: slopes, shades and curvatures take x and y for degrees, and heights for {}",
          gdal().crs_name(crs_),
          units.vertical > 0 ? fmt::format("{:.12g} metres", units.vertical) : "metres"));
    }
    return {.height = units.vertical > 0 ? units.vertical : 1,
            .degrees = units.horizontal,
            .semi_major = units.semi_major,
            .flattening = units.flattening};
  }
  const double factor = z_factor_by(units);
  if (factor == 1) return {};
  if (context().options().detail) {
    context().options().detail(
        fmt::format("{}: slopes, shades and curvatures multiply heights by {:.12g}",
                    gdal().crs_name(crs_), factor));
  }
  return {.height = factor};
}

/// Refuses a box in output coordinates that has no latitudes, where these are expected.
void DemFile::check_latitudes(const Box<2>& extent) const {
  constexpr double kRounding = 1e-6;
  const double degrees = dem_options_.ground.degrees;
  const double farthest = std::max(std::abs(extent.lo[1]), std::abs(extent.hi[1]));
  if (extent.empty() || farthest * degrees <= 90 + kRounding) return;
  throw Failure(
      fmt::format("y reaches from {:.15g} to {:.15g}, which are no latitudes of {}: how x and "
                  "y relate to heights is not known, as slopes, shades and curvatures need it",
                  extent.lo[1], extent.hi[1], gdal().crs_name(crs_)),
      ErrorCode::kBadInput, {.remedy = Remedy::kGroundScale});
}

/// Warns, once, where what is compared with heights may be degrees.
void DemFile::tell_of_degrees() {
  if (told_of_degrees_ || !crs_.empty() || options_.z_factor || !context().options().warning ||
      std::ranges::none_of(options_.products, is_by_ground)) {
    return;
  }
  const PixelGrid& grid = dem_->grid();
  const double east = grid.west + grid.columns * grid.resolution;
  const double south = grid.north - grid.rows * grid.resolution;
  const double off = grid.resolution;  // the last pixels may reach beyond
  if (grid.west < -180 - off || east > 180 + off || south < -90 - off || grid.north > 90 + off) {
    return;
  }
  told_of_degrees_ = true;
  context().options().warning(
      "warning: x and y may be degrees, as they lie within -180 to 180 and -90 to 90, and the "
      "coordinate system is not known: slopes, shades and curvatures take them for lengths in the "
      "unit of the heights; name the coordinate system, or give a factor of z, such as 1");
}

PixelGrid DemFile::grid_of(const Box<2>& extent) const {
  return choose_grid(dem_options_.grid, dem_->in_output(extent));
}

void DemFile::check_crs(const MeshStart& start) const {
  if (options_.foreign_crs) return;
  check_same_crs(start.name, start.header.crs, options_.like, like_.crs, options_.like);
  if (clip_) {
    const std::string& polygons = options_.clip.polygons;
    check_same_crs(start.name, start.header.crs, polygons, clip_->crs, polygons);
  }
  if (tiling_) {
    check_same_crs(start.name, start.header.crs, options_.tile_polygons, tiling_->crs(),
                   options_.tile_polygons);
  }
}

/// Refuses a raster that is large because of points far away, unless that is wanted. Says how large
/// it is if it may be.
void DemFile::check_size(const Box<2>& extent, std::uint64_t vertices) const {
  if (vertices == 0) return;  // not known
  const PixelGrid grid = grid_of(extent);
  if (!is_large(grid, vertices)) return;
  const Box<2> box = dem_->in_output(extent);
  const double for_each = pixels_of(grid) / static_cast<double>(vertices);
  if (options_.many_pixels || for_each <= kTooManyForAVertex) {
    if (!context().options().warning) return;
    context().options().warning(fmt::format(
        "the raster has {} x {} pixels, for {} vertices; some of them may lie far away: bounds "
        "say what to cover",
        grid.columns, grid.rows, vertices));
    return;
  }
  throw Failure(
      fmt::format("the points, {} of them, reach from {:.15g}, {:.15g} to {:.15g}, {:.15g}: that "
                  "is a raster of {} x {} pixels, {:.2g} for each of them, as if some lay far away",
                  vertices, box.lo[0], box.lo[1], box.hi[0], box.hi[1], grid.columns, grid.rows,
                  for_each),
      ErrorCode::kTooLarge, {.remedy = Remedy::kRasterExtent});
}

void DemFile::take_merged(const MergedBlock& block) { writer_->take_merged(block); }

void DemFile::give_share(ShareSender& sender) {
  with_threads(dem_options_.threads, [&] { stream::give_share(*dem_, sender); });
}

std::vector<SheetPlace> DemFile::lay_tiles(const PixelGrid& raster) {
  std::shared_ptr<const PolygonPixels> outline;
  if (clip_) outline = clipped_pixels(*clip_, options_.clip.outside, raster);
  if (!tiling_) return {{{0, raster.rows, 0, raster.columns}, outline}};
  tiles_ = tiling_->tiles(raster);
  if (outline) {
    for (RasterTile& tile : tiles_) tile.outline = outline;
  }
  std::vector<SheetPlace> places;
  for (const RasterTile& tile : tiles_) places.push_back({tile.window, tile.outline});
  return places;
}

/// Those of tiles, which may be there before all is.
std::vector<std::string> DemFile::written_files() const {
  std::vector<std::string> files;
  for (std::size_t s = 0; s < tiles_.size(); ++s) {
    if (dem_->is_written(s) && !dem_->content(s).is_empty) files.push_back(tiles_[s].path);
  }
  return files;
}

/// A tile without data has no file.
void DemFile::write_sheet(std::size_t sheet, const Progress& progress, const OtherTiles& others,
                          bool while_painting) {
  RasterOptions raster =
      file_options(tiling_ ? tiles_[sheet].path : path_, options_, dem_->raster_options(sheet));
  raster.grid.crs = crs_;
  if (while_painting) raster.memory = dem_options_.memory_of_files;
  RasterFile file(std::move(raster));
  const SheetContent content = dem_->write(file.raster(), progress, others, sheet, while_painting);
  if (!tiling_ || !content.is_empty) file.finish();
}

/// Returns how many there are. Those that were written before a run was resumed may be gone.
std::uint64_t DemFile::check_early_files() const {
  const std::vector<std::string> files = written_files();
  for (const std::string& file : files) {
    if (disk().exists(file)) continue;
    throw Failure(fmt::format("{} is gone, which was written before the run was resumed: begin "
                              "again, without what is kept of the run",
                              file),
                  ErrorCode::kInputOutput, {.file = file});
  }
  return files.size();
}

void DemFile::write_vrt(const std::vector<std::string>& files) {
  if (files.empty()) return;
  std::vector<std::string> absolute;
  absolute.reserve(files.size());
  for (const std::string& file : files) absolute.push_back(std::filesystem::absolute(file));
  const std::string text =
      gdal().mosaic_text(absolute, dem_->grid(), std::filesystem::absolute(options_.vrt));
  const auto output = disk().create(options_.vrt);
  output->write(std::as_bytes(std::span(text)));
  output->commit();
  report_.vrt = options_.vrt;
}

void DemFile::finalize(RunWatch& watch, Report& report, OtherShares& others) {
  Dem& dem = *dem_;
  const PixelGrid& grid = dem.grid();
  const OtherTiles of_others = take_shares(others, dem);
  watch.begin("write", "pixels");
  std::uint64_t pixels = 0;
  for (std::size_t s = 0; s < dem.sheets().size(); ++s) {
    pixels += std::uint64_t{dem.sheets()[s].rows} * dem.sheets()[s].columns;
  }
  const std::uint64_t early = check_early_files();
  std::uint64_t before = 0;
  const Progress progress = [&](std::uint64_t done) {
    watch.tell(before + done, static_cast<double>(before + done) / static_cast<double>(pixels));
  };
  std::vector<std::string> files = {path_};
  with_threads(dem_options_.threads, [&] {
    if (pixels_ != nullptr) {
      RasterOptions raster = dem.raster_options();
      raster.grid.crs = crs_;
      PixelsInMemory to(raster, *pixels_);
      dem.write(to, progress, of_others);
      return;
    }
    for (std::size_t s = 0; s < dem.sheets().size(); ++s) {
      if (!dem.is_written(s)) write_sheet(s, progress, of_others, false);
      before += std::uint64_t{dem.sheets()[s].rows} * dem.sheets()[s].columns;
    }
  });
  report_ = {.columns = grid.columns,
             .rows = grid.rows,
             .resolution = grid.resolution,
             .west = grid.west,
             .north = grid.north,
             .bands = dem.raster_options().bands,
             .pixels_with_data = dem.pixels_with_data(),
             .closed_tiles = dem.closed_tiles(),
             .spilled_bytes = dem.spilled_bytes(),
             .points_in_pixels = dem.points_in_pixels(),
             .pixels_with_points = dem.pixels_with_points(),
             .filled_pixels = dem.filled_pixels()};
  if (tiling_) {
    files = written_files();
    report_.files = files.size();
    report_.files_during_run = early;
    report_.empty_tiles = dem.sheets().size() - files.size();
    report_.other_files = tiling_->others_than(files);
    write_vrt(files);
  }
  if (pixels_ == nullptr) {
    report.output_format = kGeoTiff.name;
    for (const std::string& file : files) report.output_bytes += std::filesystem::file_size(file);
  }
  report.write_seconds = watch.end(pixels);
  report.left_out += dem.left_out();
  report.threads = dem_options_.threads;
}

}  // namespace spillway::stream

namespace spillway {

std::unique_ptr<DemSink> create_dem(const std::string& path, const DemOptions& options,
                                    const Context& context) {
  return std::make_unique<stream::DemFile>(path, options, context);
}

std::unique_ptr<DemSink> create_dem(DemPixels& pixels, const DemOptions& options,
                                    const Context& context) {
  return std::make_unique<stream::DemFile>(pixels, options, context);
}

}  // namespace spillway
