#include "formats/raster_file.h"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>
#include <utility>

#include "formats/file_system.h"
#include "formats/gdal/gdal.h"
#include "src/error.h"

namespace spillway {
namespace {

namespace fs = std::filesystem;

}  // namespace

RasterFile::RasterFile(RasterOptions options) {
  std::error_code error;
  const fs::path path(options.path);
  const fs::path target = fs::exists(path, error) ? fs::canonical(path) : fs::absolute(path);
  target_ = target.string();
  folder_ =
      make_temporary_folder(target.parent_path().string(), target.filename().string() + ".part-");
  path_ = (fs::path(folder_) / target.filename()).string();
  options.name = std::exchange(options.path, path_);
  try {
    raster_ = gdal().create_raster(options);
  } catch (...) {
    remove_temporary_folder(folder_);
    throw;
  }
}

RasterFile::~RasterFile() {
  raster_.reset();
  remove_temporary_folder(folder_);
}

std::uint64_t RasterFile::finish() {
  raster_->finish();
  raster_.reset();
  std::error_code error;
  const std::uint64_t bytes = fs::file_size(path_, error);
  if (!error) fs::rename(path_, target_, error);
  if (error) throw Error(fmt::format("cannot write {}: {}", target_, error.message()));
  remove_temporary_folder(folder_);
  return bytes;
}

}  // namespace spillway
