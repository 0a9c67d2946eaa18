#include "formats/disk/kept_scratch.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>

#include "src/error.h"

namespace spillway::formats {
namespace {

namespace fs = std::filesystem;

void sync_folder(const std::string& path) {
  const OpenedFile folder(path, O_RDONLY | O_DIRECTORY);
  if (folder.get() < 0 || ::fsync(folder.get()) != 0) fail_at_scratch_file("write", path, errno);
}

}  // namespace

/// What the folder and its files have in common; files may outlive it.
class KeptScratchFolder::Files {
 public:
  explicit Files(std::optional<std::uint64_t> cap) : usage(cap) {}

  ScratchUsage usage;
  std::mutex mutex;                                             // guards what follows
  std::set<std::string> written;                                // paths, since the last sync()
  std::set<std::string> reopened;                               // paths
  std::vector<std::pair<std::string, std::uint64_t>> unneeded;  // paths and bytes
  std::uint64_t made = 0;
  bool made_since_sync = false;
};

class KeptScratchFolder::File final : public DiskScratchFile {
 public:
  File(std::string path, std::uint64_t size, std::shared_ptr<Files> files)
      : DiskScratchFile(std::move(path), 0, size, files->usage), files_(std::move(files)) {}
  ~File() override {
    const std::lock_guard lock(files_->mutex);
    files_->unneeded.emplace_back(name(), size());
    files_->written.erase(name());
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  void append(std::span<const std::byte> bytes) override {
    {
      const std::lock_guard lock(files_->mutex);
      files_->written.insert(name());
    }
    DiskScratchFile::append(bytes);
  }

 private:
  std::shared_ptr<Files> files_;
};

KeptScratchFolder::KeptScratchFolder(std::string path, std::optional<std::uint64_t> cap)
    : path_(std::move(path)), files_(std::make_shared<Files>(cap)) {
  if (::mkdir(path_.c_str(), 0700) != 0 && errno != EEXIST) {
    fail_at_scratch_file("create", path_, errno);
  }
  std::error_code unknown;  // then it is told of when a file is created
  if (fs::is_symlink(path_, unknown)) fail_at_scratch_file("create", path_, ELOOP);
}

KeptScratchFolder::~KeptScratchFolder() = default;

std::unique_ptr<ScratchFile> KeptScratchFolder::create(const std::string& label) {
  std::string path;
  {
    const std::lock_guard lock(files_->mutex);
    path = (fs::path(path_) / fmt::format("{}-{}", label, ++files_->made)).string();
    files_->made_since_sync = true;
  }
  const int descriptor =
      ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW | O_CLOEXEC, 0600);
  if (descriptor < 0) fail_at_scratch_file("create", path, errno);
  ::close(descriptor);
  return std::make_unique<File>(std::move(path), 0, files_);
}

std::uint64_t KeptScratchFolder::bytes_written() const { return files_->usage.written(); }
std::uint64_t KeptScratchFolder::peak_bytes() const { return files_->usage.peak(); }

std::uint64_t KeptScratchFolder::files_made() const {
  const std::lock_guard lock(files_->mutex);
  return files_->made;
}

void KeptScratchFolder::go_on_after(std::uint64_t files_made) {
  const std::lock_guard lock(files_->mutex);
  files_->made = files_made;
}

std::unique_ptr<ScratchFile> KeptScratchFolder::reopen(const std::string& file_name,
                                                       std::uint64_t size) {
  std::string path = (fs::path(path_) / file_name).string();
  if (fs::path(file_name).filename() != file_name) {
    throw BadInput(path, "this is no file of the run: it cannot go on");
  }
  const OpenedFile file(path, O_WRONLY);
  if (file.get() < 0) {
    throw BadInput(path, std::generic_category().message(errno) + ": the run cannot go on");
  }
  const off_t end = ::lseek(file.get(), 0, SEEK_END);
  if (end < static_cast<off_t>(size)) {
    throw BadInput(FileSpot{path, at_byte(static_cast<std::uint64_t>(end))},
                   fmt::format("the file ends, of which {} bytes were written: the run cannot go "
                               "on",
                               size));
  }
  if (::ftruncate(file.get(), static_cast<off_t>(size)) != 0) {
    fail_at_scratch_file("write", path, errno);
  }
  if (!files_->usage.add(size)) {
    throw Failure(fmt::format("cannot go on with {}: temporary files take more than the {} bytes "
                              "allowed",
                              path, files_->usage.cap().value_or(0)),
                  ErrorCode::kOutOfBudget, {.file = path, .remedy = Remedy::kScratchLimit});
  }
  {
    const std::lock_guard lock(files_->mutex);
    files_->reopened.insert(path);
  }
  return std::make_unique<File>(std::move(path), size, files_);
}

std::string KeptScratchFolder::file_name_of(const ScratchFile& file) {
  return fs::path(file.name()).filename().string();
}

void KeptScratchFolder::remove_others() {
  const std::lock_guard lock(files_->mutex);
  std::error_code error;
  for (fs::directory_iterator entry(path_, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string path = entry->path().string();
    if (!files_->reopened.contains(path)) ::unlink(path.c_str());
  }
  files_->reopened.clear();
}

/// The writing of all is begun before any is waited for.
void KeptScratchFolder::sync() {
  const std::lock_guard lock(files_->mutex);
  for (const std::string& path : files_->written) {
    const OpenedFile file(path, O_WRONLY);
    if (file.get() < 0) fail_at_scratch_file("write", path, errno);
    ::sync_file_range(file.get(), 0, 0, SYNC_FILE_RANGE_WRITE);  // a hint: no result is an error
  }
  for (const std::string& path : files_->written) {
    const OpenedFile file(path, O_WRONLY);
    if (file.get() < 0 || ::fdatasync(file.get()) != 0) {
      fail_at_scratch_file("write", path, errno);
    }
  }
  if (files_->made_since_sync) sync_folder(path_);
  files_->made_since_sync = false;
  files_->written.clear();
}

void KeptScratchFolder::release() {
  const std::lock_guard lock(files_->mutex);
  for (const auto& [path, bytes] : files_->unneeded) {
    ::unlink(path.c_str());
    files_->usage.remove(bytes);
  }
  files_->unneeded.clear();
}

}  // namespace spillway::formats
