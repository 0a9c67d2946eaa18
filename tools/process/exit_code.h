#pragma once
// What the command says of its run to whoever started it.

namespace spillway::detail {

inline constexpr int kExitDone = 0;
inline constexpr int kExitFailed = 1;        ///< an Error, or a mesh that `check` refutes
inline constexpr int kExitUsage = 2;         ///< a UsageError
inline constexpr int kExitClosedPipe = 141;  ///< 128 + SIGPIPE, as shells report it

}  // namespace spillway::detail
