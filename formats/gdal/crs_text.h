#pragma once
// What a glance at the text of a coordinate system tells, without GDAL.

#include <string_view>

#include "formats/gdal/gdal.h"
#include "src/rooms.h"

namespace spillway::formats {

/// Whether it looks like WKT of either version: a word, and brackets that are all closed.
bool looks_like_wkt(std::string_view crs);

/// Whether WKT tells a system of heights beside another one.
bool is_compound_wkt(std::string_view crs);

/// Whether it may tell of heights: such WKT, or a code with two parts ("EPSG:n+m").
bool may_tell_heights(std::string_view crs);

/// The name of the system that WKT tells, the first text in quotes.
std::string_view name_in_wkt(std::string_view wkt);

/// Whether x and y are degrees, and where WKT tells of heights the metres in their unit and in that
/// of x and y; else both are 0, as what it does not tell is.
CrsUnits units_in_wkt(std::string_view wkt);

/// Whether GDAL may be able to read it: it looks like WKT, like a code ("EPSG:n") or like PROJ
/// text.
bool looks_like_crs(std::string_view crs);

}  // namespace spillway::formats
