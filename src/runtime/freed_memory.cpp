#include "src/runtime/freed_memory.h"

#include <malloc.h>

#include <algorithm>

#include "src/runtime/page_pool.h"
#include "src/runtime/process_memory.h"

namespace spillway::detail {
namespace {

/// Before memory is given back once more, the process has grown by this share of the limit.
constexpr std::uint64_t kStepShare = 16;

/// What the allocator keeps at the end of its memory, in steps.
constexpr std::uint64_t kKeptSteps = 2;

}  // namespace

FreedMemory::FreedMemory(std::uint64_t limit)
    : step_(limit / kStepShare), most_(resident_memory() + limit), next_most_(most_) {}

void FreedMemory::give_back(std::uint64_t wanted) {
  if (resident_memory() + (wanted > step_ ? wanted : 0) <= next_most_) return;
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock) return;
  PagePool::instance().give_back_free();
  malloc_trim(step_ / kKeptSteps);
  next_most_ = std::max(most_, resident_memory() + step_);
}

}  // namespace spillway::detail
