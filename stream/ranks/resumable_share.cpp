#include "stream/ranks/resumable_share.h"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>
#include <utility>

#include "src/error.h"
#include "stream/library/resumable_run.h"
#include "stream/ranks/exchange/collective_step.h"

namespace spillway::ranks {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRankFolder = "rank-";

std::string folder_of_rank(const std::string& run_folder, int rank) {
  return (fs::path(run_folder) / fmt::format("{}{}", kRankFolder, rank)).string();
}

}  // namespace

ResumableShare::ResumableShare(Run& run, const distributed::Ranks& ranks)
    : run_(run), ranks_(ranks), run_folder_(run.engine.asked.resume_folder) {
  run_collective_step(ranks_, [&] { make_run_folder(); });
  // What is refused is so before any rank makes a folder.
  const std::string own = folder_of_rank(run_folder_, ranks_.rank());
  run_collective_step(ranks_, [&] {
    if (fs::exists(own)) take_folder();
  });
  run_collective_step(ranks_, [&] {
    if (!folder_) take_folder();
  });
  checkpoints_.emplace(*folder_, run.engine.asked.checkpoint_seconds, ranks_);
  if (is_first()) tell();
}

/// Ranks of other machines may have disks of their own.
void ResumableShare::make_run_folder() const {
  make_folder(run_folder_);
  std::error_code error;
  for (fs::directory_iterator entry(run_folder_, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (name.starts_with(kRankFolder)) continue;
    throw Failure(fmt::format("{} is no folder of a run over ranks: it has {} in it; give another "
                              "folder",
                              run_folder_, name),
                  ErrorCode::kInvalidArgument, {.file = run_folder_});
  }
  if (error) {
    throw SystemRefusal(fmt::format("cannot use {} as a folder: {}", run_folder_, error.message()),
                        run_folder_, error.value());
  }
}

void ResumableShare::take_folder() {
  RunIdentity identity = *run_.identity;
  identity.add("number of ranks", fmt::format("{}", ranks_.size()));
  folder_ = std::make_shared<CheckpointFolder>(folder_of_rank(run_folder_, ranks_.rank()), identity,
                                               std::vector<std::string>(),
                                               run_.context.scratch_limit(), run_folder_);
  marked_.emplace(folder_->mark());
  run_.scratch = std::shared_ptr<ScratchFolder>(folder_, &folder_->scratch());
}

void ResumableShare::tell() const {
  const auto& warn = run_.context.options().warning;
  if (!warn) return;
  if (checkpoints_->goes_on()) {
    warn(fmt::format("goes on with the run in {}", run_folder_));
    return;
  }
  if (checkpoints_->lacked_some()) {
    warn(fmt::format("not all ranks have a checkpoint in {}: the run begins again", run_folder_));
  }
  if (const std::string notice = once_only_notice(run_); !notice.empty()) warn(notice);
}

/// Only the first rank warns, so the error itself tells it.
void ResumableShare::tell_how_to_go_on(const Failure& error) const {
  if (error.code() != ErrorCode::kInputOutput || !folder_->has_checkpoint()) return;
  throw Failure(fmt::format("{}; when that is mended, the same run goes on from what is in {}",
                            error.what(), run_folder_),
                error.code(), error.facts());
}

/// Ranks whose folder is gone begin again, so none is removed before all outputs have their names.
Report ResumableShare::complete(Report report) {
  if (const auto& detail = run_.context.options().detail; detail && is_first()) {
    detail(fmt::format("{} checkpoints took {:.2f} s at rank 0", checkpoints_->pace().count(),
                       checkpoints_->pace().seconds()));
  }
  run_collective_step(
      ranks_, [&] { CheckpointFolder::bring_to_disk(run_.identity->value_of(kOutputFact)); });
  folder_->remove();
  ranks_.barrier();
  std::error_code not_empty;
  fs::remove(run_folder_, not_empty);  // each rank, as each may have a disk of its own
  return report;
}

}  // namespace spillway::ranks
