#include <ogrsf_frmts.h>

#include <array>

#include "formats/gdal/module/gdal_errors.h"
#include "formats/gdal/vector_drivers.h"

namespace spillway::formats {

std::vector<std::string> geopackage_tables(const std::string& path) {
  forget_gdal_errors();
  std::vector<std::string> names;
  constexpr unsigned kHow = GDAL_OF_VECTOR | GDAL_OF_RASTER | GDAL_OF_READONLY;
  const std::array<const char*, 2> drivers = {"GPKG", nullptr};
  const GDALDatasetUniquePtr file(
      GDALDataset::Open(path.c_str(), kHow, drivers.data(), nullptr, nullptr));
  if (file) {
    // Layers would be those of features and attributes only.
    OGRLayer* const tables = file->ExecuteSQL(
        "SELECT table_name FROM gpkg_contents ORDER BY table_name", nullptr, nullptr);
    if (tables != nullptr) {
      for (const OGRFeatureUniquePtr& table : *tables) {
        names.emplace_back(table->GetFieldAsString(0));
      }
      file->ReleaseResultSet(tables);
    }
  }
  forget_gdal_errors();
  return names;
}

}  // namespace spillway::formats
