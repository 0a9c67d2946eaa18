#include "stream/ranks/exchange/message_size.h"

#include <algorithm>
#include <cstdint>
#include <span>

namespace spillway::ranks {

std::size_t largest_message(const MemoryBudget& budget, const distributed::Ranks& ranks) {
  constexpr std::uint64_t kShare = 32;
  constexpr std::uint64_t kLeast = std::uint64_t{64} << 10U;
  std::uint64_t limit = budget.limit();
  ranks.reduce(std::span(&limit, 1), distributed::Reduction::kLeast);
  return std::max(kLeast, limit / kShare);
}

}  // namespace spillway::ranks
