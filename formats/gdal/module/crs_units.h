#pragma once
// How coordinates of a system are measured, and whether they can become longitude and latitude;
// within the module.

#include <string>

#include "formats/gdal/gdal.h"

namespace spillway::formats {

/// What the members of Gdal of these names return.
CrsUnits crs_units(const std::string& crs);
std::string why_not_lonlat(const std::string& crs);

}  // namespace spillway::formats
