#pragma once

#include <sys/types.h>

#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "src/rooms.h"

namespace spillway::command {

/// How a child ended.
struct ChildEnd {
  pid_t id = -1;
  int exit_code = 0;  ///< 128 + signal if it was killed
};

/// Runs of this same program in processes of their own, which end with this one: whatever ends this
/// process, they are told to stop and clean up.
///
/// A child begins with the signals blocked that this process waits for, and asks for SIGTERM at the
/// death of its parent before it becomes the program: a signal that comes before the program's main
/// stays pending until the program takes it. So it is neither lost, nor does it end a child that
/// has begun something.
class ChildProcesses {
 public:
  ChildProcesses() = default;
  ~ChildProcesses() { stop(); }
  ChildProcesses(const ChildProcesses&) = delete;
  ChildProcesses& operator=(const ChildProcesses&) = delete;

  /// Starts this program with these arguments, to make the file `output`, without standard input
  /// and output; its messages go to the descriptor `log`. With "" for `output`, stop() leaves what
  /// is unfinished of it. Throws Failure with the system's reason.
  pid_t start(const std::vector<std::string>& arguments, const std::string& output, int log);

  /// Waits until one of the children has ended. There must be one.
  ChildEnd wait_for_any();

  /// Ends all children, by any thread: tells them to stop, and returns when each has cleaned up and
  /// ended. Those that have not after ten seconds are killed, and what they had begun of their
  /// outputs is removed. Another thread that calls start() or wait_for_any(), or is
  /// in it, does not come back from it.
  void stop();

 private:
  std::unique_lock<std::mutex> lock_unless_stopped();
  void reap_ended();
  void wait_for_all(int seconds);
  void kill_all();

  std::mutex mutex_;
  std::map<pid_t, std::string> running_;  // guarded by mutex_: the output of each
  bool stopped_ = false;                  // guarded by mutex_
};

}  // namespace spillway::command
