#pragma once

#include <string>
#include <string_view>

#include "src/rooms.h"

namespace spillway::formats {

/// The extension of the last part of `path`, in lower case, without the dot; empty if it has none.
std::string extension_of(std::string_view path);

}  // namespace spillway::formats
