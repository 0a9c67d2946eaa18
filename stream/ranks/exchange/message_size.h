#pragma once

#include <cstddef>

#include "src/distributed/ranks.h"
#include "src/runtime/memory_budget.h"

namespace spillway::ranks {

/// How large a message of a border may be: a 32nd of the limit of the rank that has the least, but
/// 64 KiB at least. Collective; all ranks get the same.
std::size_t largest_message(const MemoryBudget& budget, const distributed::Ranks& ranks);

}  // namespace spillway::ranks
