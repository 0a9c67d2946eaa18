#pragma once

#include <functional>
#include <string>

#include "src/rooms.h"

namespace spillway::command {

/// Makes SIGINT, SIGTERM and SIGHUP wait for handle_interrupts(), in this thread and in all that it
/// starts. To be called before anything else, as until then they end the process at once.
void block_interrupts();

/// Makes SIGINT, SIGTERM and SIGHUP, which are blocked, remove unfinished output files, say so on
/// standard error (for all ranks once), and end the process with exit code 128 + signal. A closed
/// pipe and a file beyond the process's size limit become failed writes, no signals. To be called
/// once, before any thread is started: all threads inherit the blocked signals, and one thread of
/// this function waits for them, so that removing files happens outside a signal handler. Throws
/// std::system_error if that thread cannot be started.
void handle_interrupts();

/// While it exists, such a signal first has `action` done, by the thread that waits for signals.
/// The destructor waits for an action under way, and so for the end of the process. There is one of
/// these at a time.
class InterruptAction {
 public:
  explicit InterruptAction(std::function<void()> action);
  ~InterruptAction();
  InterruptAction(const InterruptAction&) = delete;
  InterruptAction& operator=(const InterruptAction&) = delete;
};

/// While it exists, the message about such a signal ends with this. There is one of these at a
/// time.
class InterruptAdvice {
 public:
  explicit InterruptAdvice(std::string advice);
  ~InterruptAdvice();
  InterruptAdvice(const InterruptAdvice&) = delete;
  InterruptAdvice& operator=(const InterruptAdvice&) = delete;
};

}  // namespace spillway::command
