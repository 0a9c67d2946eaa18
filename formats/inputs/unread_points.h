#pragma once

#include <string_view>

#include "src/rooms.h"

namespace spillway::formats {

/// What files of points, or of grids of heights, are that are not read but might be taken for text:
/// PCD, E57, PTX, rasters of ASCII. By their first bytes; in words, empty for any other file.
std::string_view unread_points(std::string_view first_bytes);

}  // namespace spillway::formats
