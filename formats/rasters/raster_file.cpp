#include "formats/rasters/raster_file.h"

#include <array>
#include <string_view>

#include "formats/gdal/gdal.h"

namespace spillway::formats {
namespace {

/// What GDAL and others put beside a raster: overviews, metadata and statistics, masks. Readers
/// would take those of an older file of that name for the new one's.
constexpr std::array<std::string_view, 3> kSidecarEnds = {".ovr", ".aux.xml", ".msk"};

}  // namespace

RasterFile::RasterFile(RasterOptions options) : output_(options.path) {
  options.name = output_.name();
  options.path = output_.path();
  raster_ = gdal().create_raster(options);
}

std::uint64_t RasterFile::finish() {
  raster_->finish();
  raster_.reset();
  return output_.finish(kSidecarEnds);
}

}  // namespace spillway::formats
