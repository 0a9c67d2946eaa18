#pragma once
// What a glance at the text of a coordinate system tells, without GDAL.

#include <string_view>

#include "src/rooms.h"

namespace spillway::formats {

/// Whether it looks like WKT of either version: a word, and brackets that are all closed.
bool looks_like_wkt(std::string_view crs);

/// Whether WKT tells a system of heights beside another one.
bool is_compound_wkt(std::string_view crs);

/// Whether GDAL may be able to read it: it looks like WKT, like a code ("EPSG:n") or like PROJ
/// text.
bool looks_like_crs(std::string_view crs);

}  // namespace spillway::formats
