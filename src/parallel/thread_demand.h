#pragma once

namespace spillway::detail {

/// While it lives, oneTBB may run so many threads at a time, or as many as another demand beside it
/// or the machine allows, if those are more. oneTBB knows one limit for the process, of which the
/// lowest that anybody sets counts; so all demands together set one, the highest of theirs.
///
/// What remains after the last demand: oneTBB keeps threads that it has started asleep until the
/// process ends, or until its own idle pool is given up. They hold no work and no memory of ours.
class ThreadDemand {
 public:
  explicit ThreadDemand(unsigned threads);
  ~ThreadDemand();
  ThreadDemand(const ThreadDemand&) = delete;
  ThreadDemand& operator=(const ThreadDemand&) = delete;

  /// The number of threads that oneTBB may run now.
  static unsigned limit();

 private:
  unsigned threads_;
};

}  // namespace spillway::detail
