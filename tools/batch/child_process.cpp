#include "tools/batch/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "src/error.h"

namespace spillway::detail {
namespace {

constexpr int kCannotStart = 127;

/// In the child: becomes the program, or ends. Only what is safe between fork and exec.
[[noreturn]] void become(char* const* arguments, int log, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) _exit(kCannotStart);  // it has ended in between
  const int nothing = open("/dev/null", O_RDWR | O_CLOEXEC);
  if (nothing >= 0 && dup2(nothing, STDIN_FILENO) >= 0 && dup2(nothing, STDOUT_FILENO) >= 0 &&
      dup2(log, STDERR_FILENO) >= 0) {
    execv("/proc/self/exe", arguments);
  }
  _exit(kCannotStart);
}

}  // namespace

ChildProcess start_child(const std::vector<std::string>& arguments, int log) {
  std::string name = "spillway";
  std::vector<std::string> copies = arguments;
  std::vector<char*> pointers = {name.data()};
  for (std::string& copy : copies) pointers.push_back(copy.data());
  pointers.push_back(nullptr);

  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child == 0) become(pointers.data(), log, parent);
  if (child < 0) {
    throw Error(fmt::format(
        "cannot start a process: {}; raise the limit of processes (ulimit -u), or ask for fewer "
        "jobs at a time (-j)",
        std::strerror(errno)));
  }
  return {child};
}

ChildEnd wait_for_any_child() {
  int status = 0;
  pid_t id = -1;
  do {
    id = waitpid(-1, &status, 0);
  } while (id < 0 && errno == EINTR);
  if (id < 0) throw Error(fmt::format("cannot wait for a process: {}", std::strerror(errno)));
  return {id, WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status)};
}

}  // namespace spillway::detail
