#pragma once
// The formats of lines and polygons, which GDAL writes. One more is one constant here and one line
// of vector_formats().

#include <span>
#include <string>
#include <string_view>

#include "src/rooms.h"

namespace spillway::formats {

/// A format of vector files.
struct VectorFormat {
  std::string_view name;                         ///< in options of the command
  std::string_view title;                        ///< in messages
  const char* driver;                            ///< GDAL's name
  std::span<const std::string_view> extensions;  ///< in lower case
  /// Of the files beside itself that belong to it, with the dot.
  std::span<const std::string_view> part_extensions{};
  bool takes_backslash = true;  ///< in its path
  bool is_lonlat = false;       ///< holds longitude and latitude in WGS 84, and nothing else
  bool holds_polygons = true;
  bool holds_layers = false;  ///< perhaps several, made by other programs
};

namespace vector_names {
inline constexpr std::string_view kGpkg[] = {"gpkg"};
inline constexpr std::string_view kShp[] = {"shp"};
inline constexpr std::string_view kShpParts[] = {".shx", ".dbf", ".prj", ".cpg",
                                                 ".qix", ".sbn", ".sbx", ".qpj"};
inline constexpr std::string_view kDxf[] = {"dxf"};
inline constexpr std::string_view kJson[] = {"geojson", "json"};
}  // namespace vector_names

inline constexpr VectorFormat kGeoPackage = {.name = "gpkg",
                                             .title = "GeoPackage",
                                             .driver = "GPKG",
                                             .extensions = vector_names::kGpkg,
                                             .holds_layers = true};
inline constexpr VectorFormat kShapefile = {.name = "shp",
                                            .title = "Shapefile",
                                            .driver = "ESRI Shapefile",
                                            .extensions = vector_names::kShp,
                                            .part_extensions = vector_names::kShpParts,
                                            .takes_backslash = false};
inline constexpr VectorFormat kGeoJson = {.name = "geojson",
                                          .title = "GeoJSON",
                                          .driver = "GeoJSON",
                                          .extensions = vector_names::kJson,
                                          .is_lonlat = true};

inline constexpr VectorFormat kDxf = {.name = "dxf",
                                      .title = "DXF",
                                      .driver = "DXF",
                                      .extensions = vector_names::kDxf,
                                      .holds_polygons = false};

/// All of them.
std::span<const VectorFormat* const> vector_formats();

/// The format of the path's extension; null if there is none.
const VectorFormat* vector_format_of_path(std::string_view path);

/// Their extensions, the first ones or all: ".gpkg, .shp, .geojson or .json".
std::string vector_extensions(bool all);

}  // namespace spillway::formats
