#include "stream/checkpoint/checkpoint_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

#include "formats/disk/output_target.h"
#include "formats/disk/private_file.h"
#include "formats/disk/unfinished_files.h"
#include "src/error.h"

namespace spillway::stream {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRunFile = "spillway-run";
constexpr const char* kStateFile = "state";
constexpr const char* kPreparedFile = "state.prepared";
constexpr const char* kScratch = "scratch";
constexpr const char* kUnfinishedEnd = ".new";

std::string reason(int error) { return std::generic_category().message(error); }

std::string made_folder(std::string path) {
  make_folder(path);
  return path;
}

}  // namespace

/// One that is made survives whatever happens from now on.
void make_folder(const std::string& path) {
  constexpr mode_t kNobodyElseWrites = 0775;  // whatever the umask is
  if (::mkdir(path.c_str(), kNobodyElseWrites) == 0) {
    const OpenedFile parent(fs::absolute(fs::path(path) / "..").lexically_normal(),
                            O_RDONLY | O_DIRECTORY);
    if (parent.get() >= 0) ::fsync(parent.get());  // where a system cannot, it needs not
    return;
  }
  if (errno == EEXIST) return;
  const int error = errno;
  throw SystemRefusal(fmt::format("cannot create the folder {}: {}", path, reason(error)), path,
                      error);
}

CheckpointFolder::CheckpointFolder(const std::string& path, const RunIdentity& identity,
                                   std::vector<std::string> files, std::optional<std::uint64_t> cap,
                                   const std::string& run_folder)
    : path_(made_folder(path)),
      run_folder_(run_folder.empty() ? path : run_folder),
      lock_(path, O_RDONLY | O_DIRECTORY),
      files_(std::move(files)) {
  lock();
  take(identity);
  outputs_ = keep_outputs(mark_);
  scratch_ = std::make_unique<KeptScratchFolder>(path_of(kScratch), cap);
  if (!has_checkpoint() && !has(kPreparedFile)) scratch_->remove_others();
}

CheckpointFolder::CheckpointFolder(const std::string& path, std::vector<std::string> files)
    : path_(path),
      run_folder_(path),
      lock_(path, O_RDONLY | O_DIRECTORY),
      files_(std::move(files)) {
  lock();
  if (!read_run()) refuse_other_files();
}

std::string CheckpointFolder::path_of(const std::string& file_name) const {
  return (fs::path(path_) / file_name).string();
}

void CheckpointFolder::refuse(const std::string& why) const {
  throw Failure(fmt::format("cannot go on with the run in {}: {}", run_folder_, why),
                ErrorCode::kInvalidArgument, {.file = path_});
}

/// The system lets go of it when the process ends, however it does. Where a file system has no
/// locks there is none.
void CheckpointFolder::lock() {
  if (lock_.get() < 0) {
    const int error = errno;
    throw SystemRefusal(fmt::format("cannot use {} as a folder: {}", path_, reason(error)), path_,
                        error);
  }
  if (::flock(lock_.get(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    refuse("another process is at work on it");
  }
}

std::optional<RunIdentity> CheckpointFolder::read_run() {
  const auto state = open(kRunFile);
  if (!state) return {};
  RunIdentity identity;
  state->section("run");
  (*state)(mark_, identity);
  state->finish();
  return identity;
}

void CheckpointFolder::refuse_other_files() const {
  for (const fs::directory_entry& entry : fs::directory_iterator(path_)) {
    // What is left of a process that was killed before it had begun.
    const std::string name = entry.path().filename().string();
    if (name == std::string(kRunFile) + kUnfinishedEnd) continue;
    throw Failure(
        fmt::format("{} is no folder of a run that can go on, and not empty: it has {} in "
                    "it; give another folder",
                    path_, name),
        ErrorCode::kInvalidArgument, {.file = path_});
  }
}

/// Begins a run in a folder that is empty, or goes on with that of the same identity.
void CheckpointFolder::take(const RunIdentity& identity) {
  if (const std::optional<RunIdentity> earlier = read_run()) {
    const std::string difference = identity.difference_from(*earlier);
    if (!difference.empty()) {
      refuse(difference + "; give the same again, or another folder, or remove this one");
    }
    return;
  }
  refuse_other_files();
  mark_ = random_mark();
  save(kRunFile, [&](StateWriter& state) {
    state.section("run");
    RunIdentity own = identity;
    state(mark_, own);
  });
}

bool CheckpointFolder::has_unfinished(const std::string& final_path) const {
  return fs::exists(part_path(output_target(final_path).path, mark_));
}

bool CheckpointFolder::has(const std::string& file_name) const {
  return disk().exists(path_of(file_name));
}

bool CheckpointFolder::has_checkpoint() const { return has(kStateFile); }

std::unique_ptr<StateReader> CheckpointFolder::open(const std::string& file_name) {
  if (!has(file_name)) return nullptr;
  return std::make_unique<StateReader>(disk().open(path_of(file_name)), run_folder_);
}

void CheckpointFolder::remove_unfinished(const std::string& final_path) const {
  std::error_code ignored;
  fs::remove(part_path(output_target(final_path).path, mark_), ignored);
}

void CheckpointFolder::remove_all_unfinished_beside(const std::string& final_path) const {
  if (mark_.empty()) return;
  const fs::path folder = fs::absolute(output_target(final_path).path).parent_path();
  const std::string ending = part_path("", mark_);
  std::vector<fs::path> left;
  std::error_code ignored;
  for (fs::directory_iterator entry(folder, ignored), end; !ignored && entry != end;
       entry.increment(ignored)) {
    if (entry->path().filename().string().ends_with(ending)) left.push_back(entry->path());
  }
  for (const fs::path& path : left) fs::remove_all(path, ignored);
}

std::unique_ptr<StateReader> CheckpointFolder::open_state(const std::string& file_name,
                                                          std::uint64_t& files_made) {
  auto state = open(file_name);
  if (!state) return nullptr;
  state->section("checkpoint");
  (*state)(files_made);
  return state;
}

std::unique_ptr<StateReader> CheckpointFolder::open_checkpoint() {
  std::uint64_t files_made = 0;
  auto state = open_state(kStateFile, files_made);
  if (!state) return nullptr;
  state->use_scratch(*scratch_);
  scratch_->go_on_after(files_made);
  return state;
}

std::unique_ptr<StateReader> CheckpointFolder::look_at_checkpoint() {
  std::uint64_t ignored = 0;
  return open_state(kStateFile, ignored);
}

std::unique_ptr<StateReader> CheckpointFolder::look_at_prepared() {
  std::uint64_t ignored = 0;
  return open_state(kPreparedFile, ignored);
}

void CheckpointFolder::restored(StateReader& state) {
  state.finish();
  scratch_->remove_others();
}

void CheckpointFolder::save_state(const std::string& file_name,
                                  const std::function<void(StateWriter&)>& write) {
  save(file_name, [&](StateWriter& state) {
    state.section("checkpoint");
    std::uint64_t files_made = scratch_->files_made();
    state(files_made);
    write(state);
    scratch_->sync();
  });
}

void CheckpointFolder::save_checkpoint(const std::function<void(StateWriter&)>& write) {
  save_state(kStateFile, write);
  scratch_->release();
}

void CheckpointFolder::forget_checkpoint() {
  fs::remove(path_of(kStateFile));
  ::fsync(lock_.get());  // before its files go; failing that, it is found to be damaged
  scratch_->release();
}

void CheckpointFolder::prepare_checkpoint(const std::function<void(StateWriter&)>& write) {
  save_state(kPreparedFile, write);
}

void CheckpointFolder::accept_prepared() {
  rename(path_of(kPreparedFile), path_of(kStateFile));
  scratch_->release();
}

void CheckpointFolder::drop_prepared() {
  std::error_code ignored;
  fs::remove(path_of(kPreparedFile), ignored);
}

/// Survives whatever happens from now on.
void CheckpointFolder::rename(const std::string& from, const std::string& to) const {
  if (::rename(from.c_str(), to.c_str()) == 0 && ::fsync(lock_.get()) == 0) return;
  const int error = errno;
  throw SystemRefusal(fmt::format("cannot write {}: {}", to, reason(error)), to, error);
}

void CheckpointFolder::save(const std::string& file_name,
                            const std::function<void(StateWriter&)>& write) {
  const std::string path = path_of(file_name);
  const std::string unfinished = path + kUnfinishedEnd;
  StateWriter state(create_private_file(unfinished, unfinished));
  write(state);
  state.finish();
  rename(unfinished, path);
}

/// An output may be several files, and libraries write some of them.
void CheckpointFolder::bring_to_disk(const std::string& output) {
  const OpenedFile folder(fs::absolute(output_target(output).path).parent_path(),
                          O_RDONLY | O_DIRECTORY);
  if (folder.get() < 0) return;  // the output is no file
  if (::syncfs(folder.get()) == 0) return;
  const int error = errno;
  throw SystemRefusal(fmt::format("cannot write {}: {}", output, reason(error)), output, error);
}

/// Nothing but what is the run's. The file that tells of the run goes last, so that a process which
/// is killed here leaves what another one understands.
void CheckpointFolder::remove() {
  std::error_code ignored;
  const auto remove_file = [&](const std::string& name) {
    fs::remove(path_of(name), ignored);
    fs::remove(path_of(name + kUnfinishedEnd), ignored);
  };
  remove_file(kStateFile);
  remove_file(kPreparedFile);
  fs::remove_all(path_of(kScratch), ignored);
  for (const std::string& name : files_) remove_file(name);
  remove_file(kRunFile);
  fs::remove(path_, ignored);  // what is not empty stays
}

}  // namespace spillway::stream
