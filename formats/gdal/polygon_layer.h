#pragma once

#include <map>
#include <string>
#include <vector>

#include "src/geometry/point.h"

namespace spillway::formats {

/// The last point of a ring is joined to the first one.
using PolygonRings = std::vector<std::vector<Point<2>>>;

/// A polygon, or several, of a layer.
struct PolygonFeature {
  PolygonRings rings;                         ///< outer ones and holes, in no order
  std::map<std::string, std::string> fields;  ///< by name, as text
};

/// The polygons of a vector file.
struct PolygonLayer {
  std::string crs;  ///< as WKT; empty: unknown
  std::vector<PolygonFeature> polygons;
};

}  // namespace spillway::formats
