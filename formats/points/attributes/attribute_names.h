#pragma once

#include <string>
#include <string_view>

#include "src/rooms.h"

namespace spillway::formats {

/// What an attribute that other programs call so is called here, where it is one that LAS has:
/// "classification" for "class" and "Classification", "gps_time" for "GpsTime". Other names stay as
/// they are.
std::string attribute_name(std::string_view name);

}  // namespace spillway::formats
