#pragma once

#include <string>
#include <string_view>

#include "src/rooms.h"

namespace spillway::formats {

/// Throws Failure that says that the file of that format has no faces or tetrahedra, and what to do.
[[noreturn]] void fail_for_point_cloud(const std::string& file, std::string_view format);

}  // namespace spillway::formats
