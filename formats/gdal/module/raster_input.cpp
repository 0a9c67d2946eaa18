#include "formats/gdal/module/raster_input.h"

#include <fmt/format.h>
#include <gdal_priv.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <mutex>
#include <utility>
#include <vector>

#include "formats/gdal/module/crs.h"
#include "formats/gdal/module/gdal_errors.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

/// The least that GDAL keeps of blocks that have been read, in bytes: windows come block by block.
constexpr GIntBig kLeastCache = GIntBig{16} << 20;
/// The most that a block of all bands may take.
constexpr GIntBig kLargestBlock = GIntBig{256} << 20;

/// Keeps the block of each band that is being read. What is kept for other rasters stays so.
void keep_blocks(GIntBig bytes) {
  static std::mutex mutex;
  static GIntBig most = kLeastCache;
  const std::lock_guard lock(mutex);
  most = std::max(most, 2 * bytes);
  GDALSetCacheMax64(most);
}

GDALDatasetUniquePtr open_file(const std::string& path) {
  forget_gdal_errors();
  GDALDatasetUniquePtr file(
      GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_VERBOSE_ERROR));
  if (!file)
    throw BadInput(path, fmt::format("this cannot be read as a raster: {}", gdal_reason()));
  return file;
}

bool is_of_colours(GDALColorInterp meaning) {
  return meaning >= GCI_PaletteIndex && meaning <= GCI_BlackBand && meaning != GCI_AlphaBand;
}

class OpenedRaster : public RasterSource {
 public:
  explicit OpenedRaster(const std::string& path) : path_(path), file_(open_file(path)) {
    const int bands = file_->GetRasterCount();
    if (bands == 0) {
      throw BadInput(path,
                     "this holds no raster of its own; name one of those in it as gdalinfo "
                     "does, or convert it by gdal_translate");
    }
    if (file_->GetGeoTransform(facts_.place.data()) != CE_None) {
      throw BadInput(path,
                     "the raster has no geotransform, so its place is not known; gdal_edit.py "
                     "-a_ullr gives it one");
    }
    facts_.driver = file_->GetDriverName();
    facts_.columns = static_cast<std::uint32_t>(file_->GetRasterXSize());
    facts_.rows = static_cast<std::uint32_t>(file_->GetRasterYSize());
    facts_.crs = wkt_of(file_->GetSpatialRef());
    for (int b = 1; b <= bands; ++b) {
      GDALRasterBand& band = *file_->GetRasterBand(b);
      if (GDALDataTypeIsComplex(band.GetRasterDataType()) != 0) {
        throw BadInput(path, fmt::format("band {} has complex numbers, which are no heights", b));
      }
      facts_.bands.emplace_back(band.GetDescription());
    }
    GDALRasterBand& first = *file_->GetRasterBand(1);
    int columns = 0;
    int rows = 0;
    first.GetBlockSize(&columns, &rows);
    GIntBig bytes = 0;
    for (int b = 1; b <= bands; ++b) {
      bytes += GDALGetDataTypeSizeBytes(file_->GetRasterBand(b)->GetRasterDataType());
    }
    bytes *= GIntBig{columns} * rows;
    if (bytes > kLargestBlock) {
      throw Failure(
          fmt::format("{}: the raster is stored in blocks of {} x {} pixels, which take {} "
                      "MiB each; gdal_translate -co TILED=YES makes smaller ones",
                      path, columns, rows, bytes >> 20),
          ErrorCode::kTooLarge, {.file = path});
    }
    keep_blocks(bytes);
    facts_.block_columns = static_cast<std::uint32_t>(columns);
    facts_.block_rows = static_cast<std::uint32_t>(rows);
    facts_.is_picture = is_of_colours(first.GetColorInterpretation());
  }

  [[nodiscard]] const RasterFacts& facts() const override { return facts_; }

  void read(std::size_t number, const RasterWindow& window, std::span<double> values) override {
    GDALRasterBand& band = *file_->GetRasterBand(static_cast<int>(number) + 1);
    transfer(band, window, GDT_Float64, values.data());
    const double scale = band.GetScale();
    const double offset = band.GetOffset();
    if (scale != 1 || offset != 0) {
      for (double& value : values) value = value * scale + offset;
    }
    if (band.GetMaskFlags() == GMF_ALL_VALID) return;
    mask_.resize(values.size());
    transfer(*band.GetMaskBand(), window, GDT_Byte, mask_.data());
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (mask_[i] == 0) values[i] = std::numeric_limits<double>::quiet_NaN();
    }
  }

 private:
  void transfer(GDALRasterBand& band, const RasterWindow& window, GDALDataType type, void* to) {
    forget_gdal_errors();
    const int columns = static_cast<int>(window.columns);
    const int rows = static_cast<int>(window.rows);
    if (band.RasterIO(GF_Read, static_cast<int>(window.column), static_cast<int>(window.row),
                      columns, rows, to, columns, rows, type, 0, 0, nullptr) == CE_None) {
      return;
    }
    throw BadInput(path_, fmt::format("the pixels from column {} and row {} on cannot be read: {}; "
                                      "get a complete copy",
                                      window.column, window.row, gdal_reason()));
  }

  std::string path_;
  GDALDatasetUniquePtr file_;
  RasterFacts facts_;
  std::vector<std::uint8_t> mask_;  // of a window; 0: no data
};

}  // namespace

std::unique_ptr<RasterSource> open_raster_source(const std::string& path) {
  return std::make_unique<OpenedRaster>(path);
}

}  // namespace spillway::formats
