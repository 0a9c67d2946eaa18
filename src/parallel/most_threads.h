#pragma once

namespace spillway::detail {

/// Most threads that a caller may ask for: more are a slip of the pen.
inline constexpr unsigned kMostThreads = 4096;

}  // namespace spillway::detail
