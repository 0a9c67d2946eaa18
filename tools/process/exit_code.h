#pragma once

#include "src/rooms.h"
// What the command says of its run to whoever started it.

namespace spillway::command {

inline constexpr int kExitDone = 0;
inline constexpr int kExitFailed = 1;        ///< an Failure, or a mesh that `check` refutes
inline constexpr int kExitUsage = 2;         ///< a UsageError
inline constexpr int kExitClosedPipe = 141;  ///< 128 + SIGPIPE, as shells report it

}  // namespace spillway::command
