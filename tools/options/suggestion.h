#pragma once

#include <span>
#include <string>
#include <string_view>

#include "src/rooms.h"

namespace spillway::command {

/// " (did you mean --bounds?)" with the name that `word` is most likely a slip of the pen for: one
/// slip for each three letters of the longer one at most, or the beginning of a name. Nothing if
/// none is near.
std::string suggestion(std::string_view word, std::span<const std::string> names);

}  // namespace spillway::command
