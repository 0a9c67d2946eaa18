#pragma once
// Coordinate systems, within the module.

#include <ogr_spatialref.h>

#include <string>

#include "formats/gdal/gdal.h"

namespace spillway::formats {

/// The coordinate system that a text names, x east and y north. Throws Failure if it names none.
OGRSpatialReference parse_crs(const std::string& crs);

/// Without what it says of heights.
OGRSpatialReference horizontal_part(OGRSpatialReference crs);

/// What the members of Gdal of these names return.
bool same_crs(const std::string& a, const std::string& b);
std::string crs_to_wkt(const std::string& crs);
std::string crs_name(const std::string& crs);
double crs_unit(const std::string& crs);
CrsKind crs_kind(const std::string& crs);

/// The coordinate system as Gdal::crs_to_wkt() gives it; empty if there is none.
std::string wkt_of(const OGRSpatialReference* crs);

/// That of a vector layer, likewise.
std::string wkt_of_layer(const OGRSpatialReference* crs);

}  // namespace spillway::formats
