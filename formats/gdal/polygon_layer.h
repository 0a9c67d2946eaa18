#pragma once

#include <map>
#include <string>
#include <vector>

#include "src/geometry/point.h"

namespace spillway::formats {

/// A polygon, or several, of a layer.
struct PolygonFeature {
  /// Outer ones and holes, in no order; the last point of a ring is joined to the first one.
  std::vector<std::vector<Point<2>>> rings;
  std::map<std::string, std::string> fields;  ///< by name, as text
};

/// The polygons of a vector file.
struct PolygonLayer {
  std::string crs;  ///< as WKT; empty: unknown
  std::vector<PolygonFeature> polygons;
};

}  // namespace spillway::formats
