// The module's one door.

#include <cpl_conv.h>
#include <dlfcn.h>
#include <gdal.h>
#include <spillway/version.h>

#include <filesystem>
#include <system_error>

#include "formats/gdal/gdal.h"
#include "formats/gdal/module/crs.h"
#include "formats/gdal/module/crs_units.h"
#include "formats/gdal/module/gdal_errors.h"
#include "formats/gdal/module/geotiff.h"
#include "formats/gdal/module/geotiff_crs.h"
#include "formats/gdal/module/mosaic.h"
#include "formats/gdal/module/ogr_clip.h"
#include "formats/gdal/module/ogr_polygons.h"
#include "formats/gdal/module/proj_transform.h"
#include "formats/gdal/module/raster_input.h"
#include "formats/gdal/vector_drivers.h"

namespace spillway::formats {
namespace {

/// In an archive that brings GDAL along, its tables do not lie where it was built to look. A folder
/// that the user names goes before.
void use_bundled_data() {
  if (CPLGetConfigOption("GDAL_DATA", nullptr) != nullptr) return;
  Dl_info info{};
  if (::dladdr(reinterpret_cast<const void*>(&use_bundled_data), &info) == 0) return;
  std::error_code ignored;  // what cannot be looked at is not there
  const std::filesystem::path data =
      std::filesystem::path(info.dli_fname).parent_path() / "../../share/gdal";
  if (std::filesystem::is_directory(data, ignored)) {
    CPLSetConfigOption("GDAL_DATA", data.lexically_normal().c_str());
  }
}

class LoadedGdal : public Gdal {
 public:
  LoadedGdal() {
    silence_gdal();
    // Files get their final name only when complete, so that a crash may leave them broken.
    CPLSetConfigOption("OGR_SQLITE_SYNCHRONOUS", "OFF");
    CPLSetConfigOption("GDAL_PAM_ENABLED", "NO");
    use_bundled_data();
    GDALAllRegister();
  }

  [[nodiscard]] bool same_crs(const std::string& a, const std::string& b) const override {
    return spillway::formats::same_crs(a, b);
  }
  [[nodiscard]] std::string crs_to_wkt(const std::string& crs) const override {
    return spillway::formats::crs_to_wkt(crs);
  }
  [[nodiscard]] std::string crs_name(const std::string& crs) const override {
    return spillway::formats::crs_name(crs);
  }
  [[nodiscard]] double crs_unit(const std::string& crs) const override {
    return spillway::formats::crs_unit(crs);
  }
  [[nodiscard]] CrsKind crs_kind(const std::string& crs) const override {
    return spillway::formats::crs_kind(crs);
  }
  [[nodiscard]] CrsUnits crs_units(const std::string& crs) const override {
    return spillway::formats::crs_units(crs);
  }
  [[nodiscard]] std::string crs_of_geotiff_keys(const GeotiffKeys& keys,
                                                CrsKind kind) const override {
    return spillway::formats::crs_of_geotiff_keys(keys, kind);
  }
  [[nodiscard]] std::string why_not_lonlat(const std::string& crs) const override {
    return spillway::formats::why_not_lonlat(crs);
  }
  [[nodiscard]] std::unique_ptr<VectorLayer> create_layer(
      const VectorLayerOptions& options) const override {
    return create_ogr_layer(options);
  }
  [[nodiscard]] std::unique_ptr<TriangleLayer> open_layer(const std::string& path) const override {
    return open_ogr_layer(path);
  }
  [[nodiscard]] PolygonLayer read_polygons(const std::string& path) const override {
    return read_ogr_polygons(path);
  }
  [[nodiscard]] PolygonLayer read_buffers(const std::string& path, double distance) const override {
    return read_ogr_buffers(path, distance);
  }
  [[nodiscard]] std::unique_ptr<CrsTransform> create_transform(
      const std::string& from, const std::string& to) const override {
    return create_proj_transform(from, to);
  }
  [[nodiscard]] std::vector<PolygonRings> clip(const PolygonRings& polygon,
                                               const PolygonRings& area) const override {
    return clip_with_geos(polygon, area);
  }
  [[nodiscard]] std::vector<std::string> table_names(const std::string& path) const override {
    return geopackage_tables(path);
  }
  void check_raster_driver(const RasterOptions& options) const override {
    check_geotiff_driver(options);
  }
  [[nodiscard]] std::unique_ptr<Raster> create_raster(const RasterOptions& options) const override {
    return create_geotiff(options);
  }
  [[nodiscard]] std::string mosaic_text(const std::vector<std::string>& rasters,
                                        const PixelGrid& place,
                                        const std::string& path) const override {
    return spillway::formats::mosaic_text(rasters, place, path);
  }
  [[nodiscard]] std::unique_ptr<RasterSource> open_raster(const std::string& path) const override {
    return open_raster_source(path);
  }
  [[nodiscard]] RasterGrid read_raster_grid(const std::string& path) const override {
    return read_geotiff_grid(path);
  }
};

}  // namespace
}  // namespace spillway::formats

extern "C" __attribute__((visibility("default"))) const char* spillway_gdal_version() {
  return SPILLWAY_VERSION_TEXT;
}

extern "C" __attribute__((visibility("default"))) const spillway::formats::Gdal* spillway_gdal() {
  static const spillway::formats::LoadedGdal instance;
  return &instance;
}
