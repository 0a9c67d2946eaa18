#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace spillway::detail {

/// A run of this same program in a process of its own, which ends with this one: whatever ends this
/// process, the child is told to stop and cleans up.
struct ChildProcess {
  pid_t id = -1;
};

/// Starts this program with these arguments, without standard input and output; its messages go to
/// the descriptor `log`. Throws Error with the system's reason.
ChildProcess start_child(const std::vector<std::string>& arguments, int log);

/// How a child ended.
struct ChildEnd {
  pid_t id = -1;
  int exit_code = 0;  ///< 128 + signal if it was killed
};

/// Waits until one of the children has ended. There must be one.
ChildEnd wait_for_any_child();

}  // namespace spillway::detail
