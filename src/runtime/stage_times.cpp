#include "src/runtime/stage_times.h"

#include <ctime>

namespace spillway::detail {

double processor_seconds() {
  timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void StageTimes::tell(StageStep step) {
  const std::lock_guard lock(tell_mutex_);
  step_done_(step);
}

}  // namespace spillway::detail
