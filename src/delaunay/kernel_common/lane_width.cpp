#include "src/delaunay/kernel_common/lane_width.h"

#include <algorithm>
#include <atomic>

namespace spillway::delaunay {
namespace {

std::atomic<int> most_doubles = 8;

}  // namespace

int widest_lanes() {
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi") &&
      __builtin_cpu_supports("bmi2")) {
    const bool has_32_registers = __builtin_cpu_supports("avx512f") &&
                                  __builtin_cpu_supports("avx512vl") &&
                                  __builtin_cpu_supports("avx512dq");
    return has_32_registers ? 8 : 4;
  }
#endif
  return 2;
}

int lane_width() { return std::min(most_doubles.load(), widest_lanes()); }

void limit_lanes(int doubles) { most_doubles = doubles; }

}  // namespace spillway::delaunay
