#include "tools/batch/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <thread>

#include "formats/disk/unfinished_files.h"
#include "src/error.h"

namespace spillway::command {
namespace {

namespace fs = std::filesystem;

constexpr int kCannotStart = 127;

constexpr int kSecondsToCleanUp = 10;
constexpr int kSecondsToDie = 1;
constexpr std::chrono::milliseconds kPause{2};

/// A signal for the whole process group reaches this process at about the same time.
constexpr std::chrono::milliseconds kOneSignal{100};

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

/// Whether a child was ended by a signal that may be meant for this process, too.
bool is_interrupted(int exit_code) {
  return exit_code == 128 + SIGINT || exit_code == 128 + SIGTERM || exit_code == 128 + SIGHUP;
}

/// What a process has open of an output under a temporary name: a file, or a folder of files.
std::vector<fs::path> unfinished_files_of(pid_t id, const std::string& output) {
  std::vector<fs::path> files;
  if (output.empty()) return files;
  std::error_code ignored;  // closed in between, or not to be seen
  const fs::path folder = fs::canonical(fs::absolute(output, ignored).parent_path(), ignored);
  const fs::path final_path = folder / fs::path(output).filename();
  for (fs::directory_iterator entry(fmt::format("/proc/{}/fd", id), ignored), end;
       !ignored && entry != end; entry.increment(ignored)) {
    std::error_code closed;
    const fs::path file = fs::read_symlink(entry->path(), closed);
    for (const fs::path& path : {file, file.parent_path()}) {
      if (is_temporary_path(path, final_path)) files.push_back(path);
    }
  }
  return files;
}

}  // namespace

/// The lock. Not to be had any more once the children are told to stop.
std::unique_lock<std::mutex> ChildProcesses::lock_unless_stopped() {
  std::unique_lock lock(mutex_);
  if (!stopped_) return lock;
  lock.unlock();
  while (true) ::pause();
}

pid_t ChildProcesses::start(const std::vector<std::string>& arguments, const std::string& output,
                            int log) {
  std::string name = "spillway";
  std::vector<std::string> copies = arguments;
  std::vector<char*> pointers = {name.data()};
  for (std::string& copy : copies) pointers.push_back(copy.data());
  pointers.push_back(nullptr);

  const auto lock = lock_unless_stopped();
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child == 0) become(pointers.data(), log, parent);
  if (child < 0) {
    throw Failure(fmt::format(
        "cannot start a process: {}; raise the limit of processes (ulimit -u), or ask for fewer "
        "jobs at a time (-j)",
        std::strerror(errno)));
  }
  running_.emplace(child, output);
  return child;
}

/// The child stays a zombie until it is known that nobody is about to signal it.
ChildEnd ChildProcesses::wait_for_any() {
  siginfo_t ended{};
  while (waitid(P_ALL, 0, &ended, WEXITED | WNOWAIT) != 0) {
    const int reason = errno;
    if (reason == EINTR) continue;
    lock_unless_stopped();
    throw Failure(fmt::format("cannot wait for a process: {}", std::strerror(reason)));
  }
  const int exit_code = ended.si_code == CLD_EXITED ? ended.si_status : 128 + ended.si_status;
  if (is_interrupted(exit_code)) std::this_thread::sleep_for(kOneSignal);
  const auto lock = lock_unless_stopped();
  waitpid(ended.si_pid, nullptr, 0);
  running_.erase(ended.si_pid);
  return {ended.si_pid, exit_code};
}

void ChildProcesses::stop() {
  const std::lock_guard lock(mutex_);
  if (stopped_) return;
  stopped_ = true;
  for (const auto& [id, output] : running_) {
    kill(id, SIGTERM);
    kill(id, SIGCONT);  // one that is held by a debugger or Ctrl-Z would not see it
  }
  wait_for_all(kSecondsToCleanUp);
  kill_all();
}

/// With the lock held, as is what follows.
void ChildProcesses::reap_ended() {
  std::erase_if(running_,
                [](const auto& child) { return waitpid(child.first, nullptr, WNOHANG) != 0; });
}

void ChildProcesses::wait_for_all(int seconds) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(seconds);
  for (reap_ended(); !running_.empty() && std::chrono::steady_clock::now() < end; reap_ended()) {
    std::this_thread::sleep_for(kPause);
  }
}

void ChildProcesses::kill_all() {
  std::vector<fs::path> left;
  for (const auto& [id, output] : running_) {
    const std::vector<fs::path> files = unfinished_files_of(id, output);
    left.insert(left.end(), files.begin(), files.end());
    kill(id, SIGKILL);
  }
  wait_for_all(kSecondsToDie);
  std::error_code ignored;  // it is gone already, or cannot be helped
  for (const fs::path& path : left) fs::remove_all(path, ignored);
}

}  // namespace spillway::command
