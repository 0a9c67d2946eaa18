#include <spillway/context.h>
#include <spillway/error.h>

#include <fmt/format.h>

#include <utility>

#include "src/parallel/most_threads.h"
#include "src/parallel/parallel.h"
#include "src/runtime/memory_budget.h"

namespace spillway {
Context::Context(ContextOptions options) : options_(std::move(options)) {
  if (options_.threads > detail::kMostThreads) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("{} threads are more than {}", options_.threads, detail::kMostThreads));
  }
  threads_ = options_.threads > 0 ? options_.threads : detail::available_threads();
  memory_ = options_.memory.empty() ? detail::default_memory_limit()
                                    : detail::parse_memory_size(options_.memory);
  if (!options_.scratch_limit.empty()) {
    scratch_limit_ = detail::parse_memory_size(options_.scratch_limit);
  }
}

}  // namespace spillway
