#include "src/runtime/freed_memory.h"

#include <malloc.h>

#include <algorithm>

#include "src/runtime/process_memory.h"

namespace spillway::detail {
namespace {

/// What may be held beyond the limit: code that is loaded when it is first run, stacks, and gaps
/// between what is in use.
constexpr std::uint64_t kAllowance = std::uint64_t{4} << 20;

/// Before memory is given back once more, the process has grown by this share of the limit.
constexpr std::uint64_t kStepShare = 8;

/// What the allocator keeps at the end of its memory, in steps.
constexpr std::uint64_t kKeptSteps = 4;

}  // namespace

FreedMemory::FreedMemory(std::uint64_t limit)
    : step_(limit / kStepShare), most_(resident_memory() + limit + kAllowance), next_most_(most_) {}

void FreedMemory::give_back() {
  if (resident_memory() <= next_most_) return;
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock) return;
  malloc_trim(step_ / kKeptSteps);
  next_most_ = std::max(most_, resident_memory() + step_);
}

}  // namespace spillway::detail
