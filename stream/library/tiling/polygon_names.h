#pragma once

#include <string>
#include <vector>

#include "formats/gdal/polygon_layer.h"

namespace spillway::stream {

/// Polygons with a file for each.
struct NamedPolygons {
  std::string crs;                 ///< as WKT; empty: unknown
  std::vector<std::string> paths;  ///< by polygon
  /// By polygon: outer rings and holes, in no order.
  std::vector<PolygonRings> rings;
};

/// The polygons of the vector file `polygons`. The name of the file `pattern` holds fields of them
/// in braces, as in "dtm_{name}.tif". Throws Failure if they cannot be read, lack such a field, or
/// if two files would have one name.
NamedPolygons read_named_polygons(const std::string& pattern, const std::string& polygons);

}  // namespace spillway::stream
