#pragma once

#include "src/rooms.h"

namespace spillway::parallel {

/// Most threads that a caller may ask for: more are a slip of the pen.
inline constexpr unsigned kMostThreads = 4096;

}  // namespace spillway::parallel
