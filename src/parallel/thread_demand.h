#pragma once

#include "src/rooms.h"

namespace spillway::parallel {

/// While it lives, oneTBB may run that many threads at a time, or as many as another demand beside
/// it or the machine allows, if those are more. oneTBB knows one limit for the process, of which
/// the lowest that anybody sets counts; so all demands together set one, the highest of theirs.
/// Threads that have been started wait for the next demand until release() ends them.
class ThreadDemand {
 public:
  explicit ThreadDemand(unsigned threads);
  ~ThreadDemand();
  ThreadDemand(const ThreadDemand&) = delete;
  ThreadDemand& operator=(const ThreadDemand&) = delete;

  /// The number of threads that oneTBB may run now.
  static unsigned limit();

  /// Ends the threads of oneTBB, unless there is a demand or somebody else in the process has work
  /// for them. Returns whether it did.
  static bool release();

 private:
  unsigned threads_;
};

}  // namespace spillway::parallel
