#pragma once

#include <string>
#include <string_view>

#include "src/rooms.h"

namespace spillway::command {

/// Text for a terminal: control characters, of ASCII and of Unicode, those that turn the direction
/// of writing, and bytes that are no UTF-8 become \n, \t, \x1b, \u202e and the like. Names of files
/// may hold all of these. Everything else stays as it is.
std::string printable(std::string_view text);

}  // namespace spillway::command
