#include "stream/ranks/exchange/collective_step.h"

#include <cstdint>
#include <exception>
#include <span>

namespace spillway::ranks {

void run_collective_step(const distributed::Ranks& ranks, const std::function<void()>& step) {
  std::exception_ptr failure;
  try {
    step();
  } catch (...) {
    failure = std::current_exception();
  }
  const auto own = static_cast<std::uint64_t>(ranks.rank());
  const auto none = static_cast<std::uint64_t>(ranks.size());
  std::uint64_t first = failure ? own : none;
  ranks.reduce(std::span(&first, 1), distributed::Reduction::kLeast);
  if (first == none) return;
  if (first == own) std::rethrow_exception(failure);
  ranks.barrier();  // never left: the rank that throws ends the job
}

}  // namespace spillway::ranks
