#include <spillway/context.h>
#include <spillway/error.h>

#include <fmt/format.h>

#include <filesystem>
#include <system_error>
#include <utility>

#include "src/parallel/most_threads.h"
#include "src/parallel/parallel.h"
#include "src/runtime/memory_budget.h"
#include "stream/library/context/context_state.h"

namespace spillway {

Context::Context(ContextOptions options)
    : options_(std::move(options)), state_(std::make_shared<stream::ContextState>(options_.stop)) {
  if (options_.threads > parallel::kMostThreads) {
    throw Error(ErrorCode::kInvalidArgument, fmt::format("{} threads are more than {}",
                                                         options_.threads, parallel::kMostThreads));
  }
  threads_ = options_.threads > 0 ? options_.threads : parallel::available_threads();
  memory_ = options_.memory.empty() ? runtime::default_memory_limit()
                                    : runtime::parse_memory_size(options_.memory.text());
  if (!options_.scratch_limit.empty()) {
    scratch_limit_ = runtime::parse_memory_size(options_.scratch_limit.text());
  }
}

}  // namespace spillway

namespace spillway::stream {

ContextState::~ContextState() { release_threads(); }

std::shared_ptr<ScratchFolder> ContextState::scratch(const Context& context) {
  const std::lock_guard lock(mutex_);
  std::shared_ptr<ScratchFolder> folder = scratch_.lock();
  if (!folder) {
    folder = make_scratch_folder(context.options().scratch_folder, context.scratch_limit());
    scratch_ = folder;
  }
  return folder;
}

std::shared_ptr<ProbedInput> ContextState::Files::input(const std::string& path) {
  std::error_code ignored;
  if (path != "-" && (std::filesystem::is_regular_file(path, ignored) || !exists(path))) {
    return std::make_shared<ProbedInput>(*disk_, path);
  }
  const std::lock_guard lock(mutex_);
  std::shared_ptr<ProbedInput>& pipe = pipes_[path];
  if (!pipe) pipe = std::make_shared<ProbedInput>(*disk_, path);
  return pipe;
}

std::unique_ptr<InputFile> ContextState::Files::open(const std::string& path) {
  std::shared_ptr<ProbedInput> looked_at;
  {
    const std::lock_guard lock(mutex_);
    const auto found = pipes_.find(path);
    if (found != pipes_.end()) looked_at = found->second;
  }
  return looked_at ? looked_at->open(path) : disk_->open(path);
}

}  // namespace spillway::stream
