#pragma once
// The processes that a command has started, as Linux lists them.

#include <fmt/format.h>
#include <sys/types.h>

#include <fstream>
#include <vector>

namespace spillway::test {

/// Those that the first thread of a process has started and that have not ended.
inline std::vector<pid_t> children_of(pid_t process) {
  std::ifstream file(fmt::format("/proc/{0}/task/{0}/children", process));
  std::vector<pid_t> children;
  for (pid_t child = 0; file >> child;) children.push_back(child);
  return children;
}

}  // namespace spillway::test
