#include "src/runtime/stage_times.h"

#include <ctime>

namespace spillway::runtime {

namespace {

double seconds_of(clockid_t clock) {
  timespec now{};
  ::clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

double processor_seconds() { return seconds_of(CLOCK_THREAD_CPUTIME_ID); }

double process_processor_seconds() { return seconds_of(CLOCK_PROCESS_CPUTIME_ID); }

void StageTimes::tell(StageStep step) {
  const std::lock_guard lock(tell_mutex_);
  step_done_(step);
}

}  // namespace spillway::runtime
