#include "formats/gdal/module/geotiff.h"

#include <cpl_string.h>
#include <fmt/format.h>
#include <gdal_priv.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <future>
#include <limits>
#include <string_view>
#include <system_error>
#include <thread>
#include <vector>

#include "formats/gdal/module/crs.h"
#include "formats/gdal/module/gdal_errors.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

/// How far rows may be from square with columns, as a part of a pixel over the whole raster.
constexpr double kSquare = 1e-3;

/// Compression that takes little time; see docs/dem.md.
constexpr const char* kDeflateLevel = "3";
constexpr const char* kZstdLevel = "3";

std::string upper(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

[[noreturn]] void fail_for(const RasterOptions& options, const std::string& what) {
  throw SystemRefusal(fmt::format("cannot write {}: {}", options.name, what), options.name, 0);
}

/// A value from 1 to 255, rounded; no data is 0.
std::uint8_t byte_of(float value) {
  return value == 0 ? 0 : static_cast<std::uint8_t>(std::clamp(value + 0.5F, 1.0F, 255.0F));
}

/// The driver of that name, which must have the compression that is wished.
GDALDriver& driver_for(const RasterOptions& options, const char* name) {
  GDALDriver* const driver = GetGDALDriverManager()->GetDriverByName(name);
  if (driver == nullptr) {
    fail_for(options,
             fmt::format("GDAL is installed without its driver {}; install one with it", name));
  }
  if (options.compression == "none") return *driver;
  const std::string compression = upper(options.compression);
  const char* const known = driver->GetMetadataItem(GDAL_DMD_CREATIONOPTIONLIST);
  if (known == nullptr || std::string_view(known).find(compression) == std::string_view::npos) {
    fail_for(options,
             fmt::format("GDAL is installed without {} compression; choose another", compression));
  }
  return *driver;
}

/// How many of `wanted` threads can be started now, at least 1. GDAL would wait forever for work
/// that it has no thread for; with 1 it does all in the calling thread.
unsigned threads_to_be_had(unsigned wanted) {
  std::promise<void> all_here;
  const std::shared_future<void> go_on = all_here.get_future().share();
  std::vector<std::jthread> threads;
  try {
    while (threads.size() < wanted) threads.emplace_back([go_on] { go_on.wait(); });
  } catch (const std::system_error&) {  // as many as there are
  }
  all_here.set_value();
  return std::max(1U, static_cast<unsigned>(threads.size()));
}

class GeoTiff : public Raster {
 public:
  explicit GeoTiff(const RasterOptions& options)
      : options_(options),
        plain_path_(options.cloud_optimized ? options.path + ".plain" : options.path),
        threads_(threads_to_be_had(options.threads)) {
    forget_gdal_errors();
    GDALSetCacheMax64(static_cast<GIntBig>(options_.memory));
    GDALDriver& driver = driver_for(options_, "GTiff");
    const PixelGrid& grid = options_.grid.pixels;
    const CPLStringList creation = plain_options();
    file_.reset(driver.Create(plain_path_.c_str(), static_cast<int>(grid.columns),
                              static_cast<int>(grid.rows), static_cast<int>(options_.bands.size()),
                              of_bytes() ? GDT_Byte : GDT_Float32, creation.List()));
    if (!file_) fail(gdal_reason());
    is_written_.resize(tile_number(options_.bands.size(), 0, 0));
    std::array<double, 6> transform = {grid.west, grid.resolution, 0, grid.north,
                                       0,         -grid.resolution};
    if (file_->SetGeoTransform(transform.data()) != CE_None) fail(gdal_reason());
    if (!options_.grid.crs.empty()) {
      const OGRSpatialReference crs = parse_crs(options_.grid.crs);
      if (file_->SetSpatialRef(&crs) != CE_None) fail(gdal_reason());
    }
    for (std::size_t b = 0; b < options_.bands.size(); ++b) {
      band(b).SetDescription(options_.bands[b].c_str());
      if (options_.colours) continue;
      if (band(b).SetNoDataValue(options_.nodata) != CE_None) fail(gdal_reason());
    }
  }

  void write_tile(std::size_t number, std::uint32_t tile_column, std::uint32_t tile_row,
                  std::span<const float> pixels) override {
    forget_gdal_errors();
    if (of_bytes()) {
      bytes_.resize(pixels.size());
      const auto as_it_is = [](float value) { return static_cast<std::uint8_t>(value); };
      if (options_.colours) {
        std::ranges::transform(pixels, bytes_.begin(), as_it_is);
      } else {
        std::ranges::transform(pixels, bytes_.begin(), byte_of);
      }
    }
    const void* const block = of_bytes() ? static_cast<const void*>(bytes_.data()) : pixels.data();
    // Straight to the file: nothing is left to a cache that writes in an order of its own.
    const CPLErr error = band(number).WriteBlock(
        static_cast<int>(tile_column), static_cast<int>(tile_row), const_cast<void*>(block));
    if (error != CE_None || gdal_failed()) fail(gdal_reason());
    is_written_[tile_number(number, tile_column, tile_row)] = true;
  }

  void finish() override {
    forget_gdal_errors();
    check_tiles();
    file_.reset();  // closing writes what is left: only now can the disk be full
    if (gdal_failed()) fail(gdal_reason());
    if (options_.cloud_optimized) optimize();
  }

 private:
  [[nodiscard]] bool of_bytes() const {
    return options_.colours || options_.type == PixelType::kByte;
  }

  [[nodiscard]] GDALRasterBand& band(std::size_t number) {
    return *file_->GetRasterBand(static_cast<int>(number) + 1);
  }

  [[nodiscard]] std::size_t tile_number(std::size_t band_number, std::size_t column,
                                        std::size_t row) const {
    return (band_number * tile_rows() + row) * tile_columns() + column;
  }
  [[nodiscard]] std::size_t tile_columns() const {
    return (options_.grid.pixels.columns + kRasterTile - 1) / kRasterTile;
  }
  [[nodiscard]] std::size_t tile_rows() const {
    return (options_.grid.pixels.rows + kRasterTile - 1) / kRasterTile;
  }

  /// Throws Failure if a tile is not in the file: GDAL's threads that compress tiles leave out
  /// those for which they get no memory, and no call tells so.
  void check_tiles() {
    if (options_.compression == "none") return;  // empty tiles come when the file is closed
    file_->FlushCache(false);
    if (gdal_failed()) fail(gdal_reason());  // the disk is full, or the like
    for (std::size_t b = 0; b < options_.bands.size(); ++b) {
      for (std::size_t row = 0; row < tile_rows(); ++row) {
        for (std::size_t column = 0; column < tile_columns(); ++column) {
          const std::string item = fmt::format("BLOCK_SIZE_{}_{}", column, row);
          if (!is_written_[tile_number(b, column, row)] ||
              band(b).GetMetadataItem(item.c_str(), "TIFF") != nullptr) {
            continue;
          }
          fail("GDAL could not compress all pixels, most likely for want of memory");
        }
      }
    }
  }

  [[nodiscard]] CPLStringList plain_options() const {
    CPLStringList creation;
    creation.SetNameValue("TILED", "YES");
    creation.SetNameValue("BLOCKXSIZE", fmt::format("{}", kRasterTile).c_str());
    creation.SetNameValue("BLOCKYSIZE", fmt::format("{}", kRasterTile).c_str());
    creation.SetNameValue("INTERLEAVE", "BAND");
    creation.SetNameValue("BIGTIFF", "IF_SAFER");
    creation.SetNameValue("NUM_THREADS", fmt::format("{}", threads_).c_str());
    if (options_.colours) {
      creation.SetNameValue("PHOTOMETRIC", "RGB");
      creation.SetNameValue("ALPHA", "NON-PREMULTIPLIED");
    }
    if (options_.compression == "none") return creation;
    creation.SetNameValue("COMPRESS", upper(options_.compression).c_str());
    creation.SetNameValue("PREDICTOR", of_bytes() ? "2" : "3");
    creation.SetNameValue("ZLEVEL", kDeflateLevel);
    creation.SetNameValue("ZSTD_LEVEL", kZstdLevel);
    return creation;
  }

  /// Makes the file of what was written beside it.
  void optimize() const {
    GDALDriver& driver = driver_for(options_, "COG");
    const GDALDatasetUniquePtr plain(GDALDataset::Open(plain_path_.c_str(), GDAL_OF_RASTER));
    if (!plain) fail(gdal_reason());
    CPLStringList creation;
    creation.SetNameValue("COMPRESS", upper(options_.compression).c_str());
    if (options_.compression != "none") {
      creation.SetNameValue("PREDICTOR", of_bytes() ? "STANDARD" : "FLOATING_POINT");
      creation.SetNameValue("LEVEL", options_.compression == "zstd" ? kZstdLevel : kDeflateLevel);
    }
    creation.SetNameValue("BIGTIFF", "IF_SAFER");
    creation.SetNameValue("NUM_THREADS", fmt::format("{}", threads_).c_str());
    creation.SetNameValue("OVERVIEW_RESAMPLING",
                          options_.averaged_overviews ? "AVERAGE" : "NEAREST");
    GDALDatasetUniquePtr optimized(driver.CreateCopy(options_.path.c_str(), plain.get(), 0,
                                                     creation.List(), nullptr, nullptr));
    if (!optimized) fail(gdal_reason());
    optimized.reset();
    if (gdal_failed()) fail(gdal_reason());
    std::error_code error;
    std::filesystem::remove(plain_path_, error);
    if (error) fail(error.message());
  }

  [[noreturn]] void fail(const std::string& what) const { fail_for(options_, what); }

  const RasterOptions options_;
  const std::string plain_path_;
  const unsigned threads_;
  std::vector<bool> is_written_;     ///< by the number of the tile
  std::vector<std::uint8_t> bytes_;  ///< of a tile that is written
  GDALDatasetUniquePtr file_;
};

}  // namespace

void check_geotiff_driver(const RasterOptions& options) {
  static_cast<void>(driver_for(options, "GTiff"));
  if (options.cloud_optimized) static_cast<void>(driver_for(options, "COG"));
}

std::unique_ptr<Raster> create_geotiff(const RasterOptions& options) {
  return std::make_unique<GeoTiff>(options);
}

RasterGrid read_geotiff_grid(const std::string& path) {
  forget_gdal_errors();
  const GDALDatasetUniquePtr file(
      GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_VERBOSE_ERROR));
  if (!file) {
    throw Failure(fmt::format("cannot read {}: {}", path, gdal_reason()), ErrorCode::kBadInput,
                  {.file = path});
  }
  std::array<double, 6> transform{};
  if (file->GetGeoTransform(transform.data()) != CE_None) {
    throw BadInput(path, "the raster has no geotransform, so its place is not known");
  }
  const auto [west, width, row_shift, north, column_shift, height] = transform;
  const auto columns = static_cast<std::uint32_t>(file->GetRasterXSize());
  const auto rows = static_cast<std::uint32_t>(file->GetRasterYSize());
  if (!(width > 0) || row_shift != 0 || column_shift != 0 ||
      !(std::abs(width + height) * std::max(columns, rows) <= kSquare * width)) {
    throw BadInput(path, fmt::format("only rasters with square pixels and north up can be followed "
                                     "(gdalwarp makes them); a pixel is {} by {}",
                                     width, -height));
  }
  return {{west, north, width, columns, rows}, wkt_of(file->GetSpatialRef())};
}

}  // namespace spillway::formats
