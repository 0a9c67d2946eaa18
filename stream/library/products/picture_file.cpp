#include "stream/library/products/picture_file.h"

#include <fmt/format.h>

#include <optional>
#include <utility>
#include <vector>

#include "formats/disk/output_check.h"
#include "formats/gdal/gdal.h"
#include "formats/rasters/png.h"
#include "formats/rasters/raster_file.h"
#include "formats/rasters/raster_formats.h"
#include "formats/rasters/world_file.h"
#include "src/parallel/parallel.h"
#include "stream/library/choice_check.h"
#include "stream/library/context/context_state.h"
#include "stream/library/products/page_file.h"
#include "stream/library/products/picture_check.h"
#include "stream/plan/memory_plan.h"

namespace spillway::stream {
namespace {

/// What a pixel takes while the picture is drawn, when the mesh has gone through; if it has the
/// colours of numbers; and what more where rays meet the surface.
constexpr std::uint64_t kBytesOfAPixel = 16;
constexpr std::uint64_t kBytesOfAColouredPixel = 24;
constexpr std::uint64_t kBytesOfAFieldsPixel = 10;

void check_size(std::uint32_t size) {
  if (size >= kLeastPictureSize && size <= kMostPictureSize) return;
  throw InvalidArgument(fmt::format("a picture has {} to {} pixels a side, not {}",
                                    kLeastPictureSize, kMostPictureSize, size));
}

/// What lies on a map is seen from above.
void check_view(const PictureOptions& options, bool is_geotiff) {
  if (!options.view) return;
  if (is_geotiff || options.world_file || options.scale_bar) {
    throw InvalidArgument(fmt::format("{} is of a map, and a view is none: leave one of both out",
                                      is_geotiff           ? "a GeoTIFF"
                                      : options.world_file ? "a world file"
                                                           : "a scale bar"));
  }
}

/// What GeoTIFF does not have.
void check_geotiff(const std::string& path, const PictureOptions& options) {
  if (!can_be_tried(path)) {
    throw InvalidArgument(
        fmt::format("{}: a GeoTIFF is not written in one go, so it needs a file", path));
  }
  if (options.legend || options.scale_bar) {
    throw InvalidArgument(
        "a GeoTIFF lies on a map, where no words go: leave out legend and scale "
        "bar, or make a PNG");
  }
  if (options.transparent) {
    throw InvalidArgument("the background of a GeoTIFF is transparent anyway: leave that out");
  }
  if (options.world_file) {
    throw InvalidArgument("a GeoTIFF tells its place itself: leave the world file out");
  }
}

void check_path(const std::string& path, const PictureOptions& options) {
  if (kGeoTiff.is_named(path)) {
    check_geotiff(path, options);
  } else if (path != "-" && !kPng.is_named(path)) {
    throw InvalidArgument(fmt::format("{}: a picture is a .{} or a .{}, and a page is an .{}", path,
                                      kPng.extensions.front(), kGeoTiff.extensions.front(),
                                      kHtml.extensions.front()));
  }
  if (path == "-" && options.world_file) {
    throw InvalidArgument("a world file lies beside its picture: name a file");
  }
}

}  // namespace

PictureFile::PictureFile(const std::string& path, const PictureOptions& options,
                         const Context& context)
    : OwnSink(context),
      path_(path),
      options_(options),
      scratch_(context.state().scratch(context)),
      is_geotiff_(kGeoTiff.is_named(path)) {
  check_path(path_, options_);
  check_picture(options_);
  check_view(options_, is_geotiff_);
  const std::uint32_t size = picture_size(options_);
  check_size(size);
  if (options.triangles) {
    throw InvalidArgument("a number of triangles is of a page, FILE.html, and not of a picture");
  }
  std::uint64_t bytes =
      options_.colour == PictureColour::kHeight ? kBytesOfAPixel : kBytesOfAColouredPixel;
  if (options_.view || options_.shadows) bytes += kBytesOfAFieldsPixel;
  check_picture_memory(fmt::format("a picture of {} pixels a side", size),
                       std::uint64_t{size} * size * bytes, context.memory());
  check_can_create(path_);
  if (options_.world_file) check_can_create(world_file_path(path_));
}

CrsNeed PictureFile::crs_need() const {
  return is_geotiff_ || options_.scale_bar ? CrsNeed::kAll : CrsNeed::kNone;
}

std::uint64_t PictureFile::own_memory(std::uint64_t limit) const { return limit / kPixelShare; }

unsigned PictureFile::feeding_threads(unsigned threads) const {
  const std::uint64_t limit = context().memory();
  return threads_beside(own_memory(limit), limit, threads);
}

BlockSink& PictureFile::open(const MeshStart& start) {
  dimension_ = start.header.dimension;
  refuse_higher_dimensions(dimension_, "a picture shows");
  if (dimension_ == 2) check_seen_from_above(options_);
  if (dimension_ == 2 && (options_.view || options_.shadows)) refuse_without_heights(start);
  crs_ = start.header.crs;
  if (is_geotiff_ && dimension_ != 2) {
    throw InvalidArgument("a GeoTIFF lies on a map, and these are tetrahedra: make a PNG");
  }
  mesh_ = {.lattice = start.header.lattice,
           .max_edge = start.is_triangulated ? std::nullopt : options_.max_edge,
           .attributes = start.header.attributes};
  return *begin_again();
}

BlockSink* PictureFile::begin_again() {
  scene_.reset();
  scene_ = dimension_ == 2 ? make_relief_scene(options_, mesh_, own_memory(context().memory()),
                                               feeding_threads(context().threads()), *scratch_)
                           : make_space_scene(options_, mesh_);
  if (options_.zoom) scene_->extent_known({});
  return &scene_->writer();
}

void PictureFile::extent_known(const Box<2>& extent, std::uint64_t /*vertices*/) {
  if (wants_extent()) scene_->extent_known(extent);
}

void PictureFile::finalize(RunWatch& watch, Report& report, OtherShares& /*others*/) {
  scene_->writer().finish(report.mesh);
  watch.begin("draw", "pixels");
  std::optional<Picture> picture;
  with_threads(feeding_threads(context().threads()), [&] { picture = scene_->draw(); });
  report_.columns = picture->columns();
  report_.rows = picture->rows();
  if (is_geotiff_) {
    report.output_format = kGeoTiff.name;
    report.output_bytes = write_as_geotiff(*picture);
  } else {
    if (!options_.transparent) picture->put_onto(kWhite);
    add_words(*picture);
    report_.rows = picture->rows();
    report.output_format = kPng.name;
    report.output_bytes = write_as_png(*picture);
  }
  report.write_seconds = watch.end(std::uint64_t{report_.columns} * report_.rows);
  report.left_out += scene_->left_out();
  report_.description = scene_->description();
  report_.edges_too_small = scene_->edges_too_small();
}

void PictureFile::add_words(Picture& picture) const {
  std::optional<ScaleBar> bar;
  if (options_.scale_bar) {
    const CrsUnits units = crs_.empty() ? CrsUnits{.horizontal = 0} : gdal().crs_units(crs_);
    bar = choose_scale_bar(picture.columns(), scene_->place()->resolution,
                           units.is_geographic ? 0 : units.horizontal);
  }
  if (!options_.legend && !bar) return;
  add_strip(picture, bar, options_.legend ? scene_->legend() : std::nullopt, options_.transparent);
}

std::uint64_t PictureFile::write_as_png(const Picture& picture) {
  const std::uint64_t bytes = write_png(disk(), path_, picture.columns(), picture.rows(),
                                        picture.bytes(), options_.transparent);
  if (options_.world_file) write_world_file(disk(), world_file_path(path_), *scene_->place());
  return bytes;
}

std::uint64_t PictureFile::write_as_geotiff(const Picture& picture) {
  RasterOptions options;
  options.path = options.name = path_;
  options.grid = {*scene_->place(), crs_};
  options.bands = {"red", "green", "blue", "opacity"};
  options.colours = true;
  options.threads = feeding_threads(context().threads());
  RasterFile file(std::move(options));
  std::vector<float> tile(std::size_t{kRasterTile} * kRasterTile);
  for (std::uint32_t row = 0; row < picture.rows(); row += kRasterTile) {
    for (std::uint32_t column = 0; column < picture.columns(); column += kRasterTile) {
      for (std::size_t band = 0; band < Picture::kChannels; ++band) {
        for (std::size_t i = 0; i < tile.size(); ++i) {
          const std::size_t r = row + i / kRasterTile;
          const std::size_t c = column + i % kRasterTile;
          const bool is_in = r < picture.rows() && c < picture.columns();
          tile[i] = is_in ? picture.bytes()[(r * picture.columns() + c) * Picture::kChannels + band]
                          : 0.0F;
        }
        file.raster().write_tile(band, column / kRasterTile, row / kRasterTile, tile);
      }
    }
  }
  return file.finish();
}

}  // namespace spillway::stream

namespace spillway {

std::unique_ptr<PictureSink> create_picture(const std::string& path, const PictureOptions& options,
                                            const Context& context) {
  if (formats::kHtml.is_named(path)) {
    return std::make_unique<stream::PageFile>(path, options, context);
  }
  return std::make_unique<stream::PictureFile>(path, options, context);
}

}  // namespace spillway
