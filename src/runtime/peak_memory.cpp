#include "src/runtime/peak_memory.h"

#include <sys/resource.h>

namespace spillway::detail {

std::uint64_t peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // Linux counts in KiB
}

}  // namespace spillway::detail
