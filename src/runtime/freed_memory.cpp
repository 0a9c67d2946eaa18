#include "src/runtime/freed_memory.h"

#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <mutex>

#include "src/runtime/page_pool.h"
#include "src/runtime/process_memory.h"
#include "src/runtime/run_memory.h"

namespace spillway::runtime {
namespace {

/// Before memory is given back once more, the process has grown by this share of the limit.
constexpr std::uint64_t kStepShare = 16;

/// What the allocator keeps at the end of its memory, in steps.
constexpr std::uint64_t kKeptSteps = 2;

/// What all runs under way may hold together, in bytes.
struct AllRuns {
  std::mutex mutex;
  unsigned count = 0;                   // guarded by mutex
  std::atomic<std::uint64_t> most = 0;  // that the process may hold
};

AllRuns& all_runs() {
  static AllRuns instance;
  return instance;
}

}  // namespace

FreedMemory::FreedMemory(std::uint64_t limit) : limit_(limit), step_(limit / kStepShare) {
  AllRuns& runs = all_runs();
  const std::lock_guard lock(runs.mutex);
  if (runs.count++ == 0) runs.most = resident_memory();
  runs.most += limit;
}

FreedMemory::~FreedMemory() {
  AllRuns& runs = all_runs();
  const std::lock_guard lock(runs.mutex);
  --runs.count;
  runs.most -= limit_;
}

void FreedMemory::give_back(std::uint64_t wanted) {
  const std::uint64_t most = all_runs().most;
  if (resident_memory() + (wanted > step_ ? wanted : 0) <=
      std::max<std::uint64_t>(most, next_most_)) {
    return;
  }
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock) return;
  RunMemory::current().get<PagePool>()->give_back_free();
  malloc_trim(step_ / kKeptSteps);
  next_most_ = resident_memory() + step_;
}

}  // namespace spillway::runtime
