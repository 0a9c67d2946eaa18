#pragma once
// The seam to GDAL: coordinate systems, GeoTIFF, vector files. GDAL brings a hundred shared
// libraries, so it stands in a module of its own that is loaded when first needed: a run that needs
// none of it pays nothing.

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "formats/gdal/geotiff_key_records.h"
#include "formats/gdal/polygon_layer.h"
#include "formats/gdal/raster.h"
#include "formats/gdal/raster_source.h"
#include "formats/gdal/vector_layer.h"

namespace spillway::formats {

/// What the coordinates of a system are.
enum class CrsKind : std::uint8_t {
  kProjected,   ///< lengths on a map
  kGeographic,  ///< angles, perhaps with a height
  kGeocentric,  ///< x, y, z from the centre of the earth
  kOther,       ///< heights alone, several systems together, a site's own
  kUnknown,     ///< none that GDAL knows
};

/// How coordinates of a system are measured.
struct CrsUnits {
  bool is_geographic = false;  ///< x and y are longitude and latitude, perhaps with a height
  double horizontal = 1;       ///< metres in a unit of x and y; degrees, if they are angles
  double vertical = 0;         ///< metres in a unit of z; 0: not told
  double semi_major = 0;       ///< of the ellipsoid, in metres
  double flattening = 0;       ///< of the ellipsoid
};

/// Brings points from one coordinate system to another. For one thread at a time.
class CrsTransform {
 public:
  CrsTransform() = default;
  virtual ~CrsTransform() = default;
  CrsTransform(const CrsTransform&) = delete;
  CrsTransform& operator=(const CrsTransform&) = delete;

  /// Coordinates of one axis each, of equal counts, become those of the other system; of points that
  /// have none there, infinite ones.
  virtual void apply(std::span<double> x, std::span<double> y, std::span<double> z) = 0;
};

/// What the module offers. A coordinate system is given as WKT (1 or 2), as "EPSG:n" or as PROJ
/// text; what GDAL takes for none of these is an Failure. May be called by many threads.
class Gdal {
 public:
  Gdal() = default;
  virtual ~Gdal() = default;
  Gdal(const Gdal&) = delete;
  Gdal& operator=(const Gdal&) = delete;

  /// Whether two coordinate systems are the same one, however they are written. The order of axes
  /// does not matter: coordinates are always x (east), y (north). Where only one of them has a
  /// vertical part, the horizontal parts alone are compared; where both have, both parts count.
  [[nodiscard]] virtual bool same_crs(const std::string& a, const std::string& b) const = 0;

  /// A coordinate system as WKT in one line: version 1 in GDAL's dialect, which LAS files need, or
  /// version 2 if the first cannot tell it.
  [[nodiscard]] virtual std::string crs_to_wkt(const std::string& crs) const = 0;

  /// A short name for messages: "EPSG:2927 (NAD83(HARN) / Washington South (ftUS))".
  [[nodiscard]] virtual std::string crs_name(const std::string& crs) const = 0;

  /// Metres in a unit of x and y; 0 if these are angles.
  [[nodiscard]] virtual double crs_unit(const std::string& crs) const = 0;

  /// What kind of system it is.
  [[nodiscard]] virtual CrsKind crs_kind(const std::string& crs) const = 0;

  /// How x, y and z are measured.
  [[nodiscard]] virtual CrsUnits crs_units(const std::string& crs) const = 0;

  /// The system that GeoTIFF keys define, with its heights, as crs_to_wkt() gives it; empty if
  /// they define none whose horizontal part is of this kind.
  [[nodiscard]] virtual std::string crs_of_geotiff_keys(const GeotiffKeys& keys,
                                                        CrsKind kind) const = 0;

  /// Brings coordinates from one system to another by PROJ, x to the east and y to the north in
  /// both. Throws Failure if it cannot.
  [[nodiscard]] virtual std::unique_ptr<CrsTransform> create_transform(
      const std::string& from, const std::string& to) const = 0;

  /// Why coordinates cannot be brought to longitude and latitude of WGS 84, in words; empty if they
  /// can.
  [[nodiscard]] virtual std::string why_not_lonlat(const std::string& crs) const = 0;

  /// Begins a vector file of one layer.
  [[nodiscard]] virtual std::unique_ptr<VectorLayer> create_layer(
      const VectorLayerOptions& options) const = 0;

  /// Opens the one layer of triangles of a vector file.
  [[nodiscard]] virtual std::unique_ptr<TriangleLayer> open_layer(
      const std::string& path) const = 0;

  /// The polygons of a vector file of one layer; arcs become short lines. Throws Failure for other
  /// geometries.
  [[nodiscard]] virtual PolygonLayer read_polygons(const std::string& path) const = 0;

  /// The areas of what is no farther than `distance` from the geometries of a vector file of one
  /// layer, of polygons, lines or points, with round corners; below 0: of what is that far inside of
  /// polygons. Throws Failure if nothing is left.
  [[nodiscard]] virtual PolygonLayer read_buffers(const std::string& path,
                                                  double distance) const = 0;

  /// What a polygon, its outer ring first, has in common with those of `area`, whose rings come in
  /// no order: each its outer ring, counter-clockwise, then its holes, clockwise. What has no area is
  /// left out. Of an area that crosses itself, the even-odd rule tells the inside. Throws Failure for
  /// a polygon that crosses itself.
  [[nodiscard]] virtual std::vector<PolygonRings> clip(const PolygonRings& polygon,
                                                       const PolygonRings& area) const = 0;

  /// The names of all tables of a GeoPackage, of features, attributes and tiles; none if it cannot
  /// be read.
  [[nodiscard]] virtual std::vector<std::string> table_names(const std::string& path) const = 0;

  /// Throws Failure if GDAL lacks what create_raster() needs for these options, of which name,
  /// compression and cloud_optimized are looked at.
  virtual void check_raster_driver(const RasterOptions& options) const = 0;

  /// Begins a GeoTIFF.
  [[nodiscard]] virtual std::unique_ptr<Raster> create_raster(
      const RasterOptions& options) const = 0;

  /// The text of a VRT that puts rasters of the same bands together, which are at absolute paths,
  /// for a file at the absolute `path`. It covers `place`.
  [[nodiscard]] virtual std::string mosaic_text(const std::vector<std::string>& rasters,
                                                const PixelGrid& place,
                                                const std::string& path) const = 0;

  /// Opens a raster of any format that GDAL reads. Throws Failure if it is none, and where it is not
  /// told where its pixels lie.
  [[nodiscard]] virtual std::unique_ptr<RasterSource> open_raster(
      const std::string& path) const = 0;

  /// Where an existing raster lies. Throws Failure if its pixels are not square, north up.
  [[nodiscard]] virtual RasterGrid read_raster_grid(const std::string& path) const = 0;
};

/// The module, loaded at the first call. Throws Failure if it, or GDAL in this build, is not there.
const Gdal& gdal();

/// What the module has under the name kGdalFactory: it returns what gdal() gives.
using GdalFactory = const Gdal* (*)();
inline constexpr const char* kGdalFactory = "spillway_gdal";

/// The other function that the module has, under the name kGdalVersion: it returns the version of
/// Spillway that the module is of, which must be the caller's.
using GdalVersion = const char* (*)();
inline constexpr const char* kGdalVersion = "spillway_gdal_version";

}  // namespace spillway::formats
