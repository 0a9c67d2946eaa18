#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>

#include "src/geometry/framed_point.h"
#include "src/geometry/point.h"

namespace spillway::formats {

/// What features of a layer are.
enum class VectorContent : std::uint8_t { kTriangles, kLines, kBands };

/// What a vector file of one layer holds.
struct VectorLayerOptions {
  std::string path;    ///< of the file to create, which is not there yet
  std::string name;    ///< of the file in messages
  std::string driver;  ///< GDAL's name: "GPKG", "ESRI Shapefile", "GeoJSON", "DXF"
  std::string layer;   ///< the layer's name; a shapefile takes it from its path instead
  VectorContent content = VectorContent::kTriangles;
  std::string crs;  ///< as Gdal takes it; empty: unknown
  /// Where the driver brings coordinates to longitude and latitude (GeoJSON), and it is not known
  /// from what: write them as they are, instead of an error.
  bool as_they_are = false;
  /// Said about the layer where the driver can hold it (GeoPackage); dropped elsewhere.
  std::map<std::string, std::string> metadata;
};

/// A line of equal height.
struct ContourLine {
  std::span<const WorldPoint> points;  ///< closed if its ends are equal
  double elevation = 0;
  bool is_index = false;
};

/// What lies between two heights, or a part of it.
struct ContourBand {
  /// The first one counter-clockwise around the others, which are holes and run clockwise. Closed:
  /// the last point of a ring is joined to the first one.
  std::span<const std::span<const Point<2>>> rings;
  double least = 0;
  double greatest = 0;
};

/// A layer being written. The file is not complete before finish(), and is left as it is if the
/// layer is destroyed without. Throws Failure with GDAL's reason.
class VectorLayer {
 public:
  VectorLayer() = default;
  virtual ~VectorLayer() = default;
  VectorLayer(const VectorLayer&) = delete;
  VectorLayer& operator=(const VectorLayer&) = delete;

  /// Adds a triangle as a polygon with z.
  virtual void add_triangle(std::span<const WorldPoint, 3> corners) = 0;
  /// Adds a line with z and the attributes "elevation" and "index" (1 or 0). DXF has no
  /// attributes: it has a layer for index contours, and one for the others.
  virtual void add_line(const ContourLine& line) = 0;
  /// Adds a polygon without z and the attributes "min" and "max".
  virtual void add_band(const ContourBand& band) = 0;
  /// Completes and closes the file.
  virtual void finish() = 0;
};

/// A layer of triangles being read: polygons of three corners, TINs, or collections of these.
/// Throws Failure with the feature's number for anything else.
class TriangleLayer {
 public:
  TriangleLayer() = default;
  virtual ~TriangleLayer() = default;
  TriangleLayer(const TriangleLayer&) = delete;
  TriangleLayer& operator=(const TriangleLayer&) = delete;

  /// The coordinate system as WKT; empty if unknown.
  [[nodiscard]] virtual std::string crs() const = 0;
  /// What VectorLayerOptions::metadata said of this name; empty if nothing.
  [[nodiscard]] virtual std::string metadata(const std::string& name) const = 0;
  /// The next triangle, counter-clockwise in x, y, with z 0 where there is none; false at the end.
  virtual bool next(std::array<WorldPoint, 3>& corners) = 0;
};

}  // namespace spillway::formats
