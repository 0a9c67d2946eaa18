#include "stream/ranks/resumable_share.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

#include "src/error.h"
#include "stream/library/resumable_run.h"
#include "stream/ranks/exchange/collective_step.h"

namespace spillway::detail {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRankFolder = "rank-";

std::string folder_of_rank(const std::string& run_folder, int rank) {
  return (fs::path(run_folder) / fmt::format("{}{}", kRankFolder, rank)).string();
}

}  // namespace

ResumableShare::ResumableShare(Run& run, const distributed::Ranks& ranks)
    : run_(run), ranks_(ranks), run_folder_(run.options.resume_folder) {
  run_collective_step(ranks_, [&] { make_run_folder(); });
  run_collective_step(ranks_, [&] { take_folder(); });
  checkpoints_.emplace(*folder_, run.options.checkpoint_seconds, ranks_);
  if (is_first()) tell();
}

/// Ranks of other machines may have disks of their own.
void ResumableShare::make_run_folder() const {
  if (::mkdir(run_folder_.c_str(), 0777) != 0 && errno != EEXIST) {
    const int error = errno;
    throw SystemRefusal(fmt::format("cannot create the folder {}: {}", run_folder_,
                                    std::generic_category().message(error)),
                        run_folder_, error);
  }
  for (const fs::directory_entry& entry : fs::directory_iterator(run_folder_)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(kRankFolder)) continue;
    throw Error(fmt::format("{} is no folder of a run over ranks: it has {} in it; give another "
                            "folder",
                            run_folder_, name),
                ErrorCode::kInvalidArgument, {.file = run_folder_});
  }
}

void ResumableShare::take_folder() {
  RunIdentity identity = *run_.identity;
  identity.add("number of ranks", fmt::format("{}", ranks_.size()));
  folder_ =
      std::make_shared<CheckpointFolder>(folder_of_rank(run_folder_, ranks_.rank()), identity,
                                         std::vector<std::string>(), run_.context.scratch_limit());
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

/// Ranks whose folder is gone begin again, so none is removed before all outputs have their names.
Report ResumableShare::complete(Report report) {
  ranks_.barrier();
  folder_->remove();
  ranks_.barrier();
  std::error_code not_empty;
  if (is_first()) fs::remove(run_folder_, not_empty);
  return report;
}

}  // namespace spillway::detail
