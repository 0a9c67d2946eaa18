#include "formats/gdal/module/mosaic.h"

#include <cpl_string.h>
#include <fmt/format.h>
#include <gdal_priv.h>
#include <gdal_utils.h>

#include <memory>

#include "formats/gdal/module/gdal_errors.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

struct FreeOptions {
  void operator()(GDALBuildVRTOptions* options) const { GDALBuildVRTOptionsFree(options); }
};

}  // namespace

std::string mosaic_text(const std::vector<std::string>& rasters, const PixelGrid& place,
                        const std::string& path) {
  forget_gdal_errors();
  const auto fail = [&path] {
    throw SystemRefusal(fmt::format("cannot write {}: {}", path, gdal_reason()), path, 0);
  };
  CPLStringList arguments;
  for (const std::string& one :
       {std::string("-resolution"), std::string("user"), std::string("-tr"),
        fmt::format("{:.17g}", place.resolution), fmt::format("{:.17g}", place.resolution),
        std::string("-te"), fmt::format("{:.17g}", place.west),
        fmt::format("{:.17g}", place.north - place.rows * place.resolution),
        fmt::format("{:.17g}", place.west + place.columns * place.resolution),
        fmt::format("{:.17g}", place.north)}) {
    arguments.AddString(one.c_str());
  }
  const std::unique_ptr<GDALBuildVRTOptions, FreeOptions> options(
      GDALBuildVRTOptionsNew(arguments.List(), nullptr));
  CPLStringList names;
  for (const std::string& raster : rasters) names.AddString(raster.c_str());
  const GDALDatasetUniquePtr mosaic(GDALDataset::FromHandle(
      GDALBuildVRT("", names.Count(), nullptr, names.List(), options.get(), nullptr)));
  if (!mosaic || gdal_failed()) fail();
  const GDALDatasetUniquePtr first(
      GDALDataset::Open(rasters.front().c_str(), GDAL_OF_RASTER | GDAL_OF_VERBOSE_ERROR));
  if (!first) fail();
  for (int b = 1; b <= mosaic->GetRasterCount(); ++b) {
    mosaic->GetRasterBand(b)->SetDescription(first->GetRasterBand(b)->GetDescription());
  }
  // Files in the folder of the VRT are named as they are from there.
  mosaic->SetDescription(path.c_str());
  const char* const* const text = mosaic->GetMetadata("xml:VRT");
  if (text == nullptr || *text == nullptr) fail();
  std::string result = *text;
  mosaic->SetDescription("");  // nothing is written there
  return result;
}

}  // namespace spillway::formats
