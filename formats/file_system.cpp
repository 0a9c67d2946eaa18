#include "formats/file_system.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <set>
#include <system_error>
#include <utility>
#include <vector>

#include "src/error.h"

namespace spillway {
namespace {

constexpr std::size_t kOutputBuffer = std::size_t{1} << 20;

// Linux transfers at most 2 GiB - 4 KiB in one call; smaller pieces keep errors close to the cause.
constexpr std::size_t kLargestTransfer = std::size_t{1} << 28;

std::string reason(int error) { return std::generic_category().message(error); }

std::string folder_of(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  return folder.empty() ? "." : folder;
}

/// What the user can do about a failure to write or create.
std::string output_hint(int error, const std::string& path) {
  const std::string folder = folder_of(path);
  switch (error) {
    case ENOENT:
    case ENOTDIR:
      return fmt::format("; create the folder {} first", folder);
    case EACCES:
    case EPERM:
    case EROFS:
      return fmt::format("; choose a folder other than {}, or change its permissions", folder);
    case ENOSPC:
    case EDQUOT:
      return "; free some space or write to another disk";
    case EFBIG:
      return "; raise the file size limit (ulimit -f) or write to another file system";
    default:
      return "";
  }
}

/// The temporary names that exist now. Locked for each change on disk, so that a file is either
/// registered under its temporary name, or in a registered folder, or complete under its final one.
struct UnfinishedFiles {
  std::mutex mutex;
  std::set<std::string> paths;    // guarded by mutex
  std::set<std::string> folders;  // guarded by mutex
};

UnfinishedFiles& unfinished_files() {
  static UnfinishedFiles files;
  return files;
}

/// Owns a file descriptor.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  [[nodiscard]] int get() const { return fd_; }

  /// Closes and returns 0, or the error that closing met.
  int close() {
    const int fd = std::exchange(fd_, -1);
    return fd >= 0 && ::close(fd) != 0 ? errno : 0;
  }

 private:
  int fd_;
};

class DiskInput : public InputFile {
 public:
  DiskInput(int fd, std::string name) : file_(fd), name_(std::move(name)) {
    struct stat status {};
    if (::fstat(fd, &status) != 0) fail(errno);
    if (S_ISDIR(status.st_mode)) {
      throw Error(fmt::format("cannot read {}: it is a folder; name a file in it", name_));
    }
    if (S_ISREG(status.st_mode)) {
      // Standard input may have been read from before: what counts is the rest.
      start_ = std::max<off_t>(0, ::lseek(fd, 0, SEEK_CUR));
      size_ = static_cast<std::uint64_t>(std::max<off_t>(0, status.st_size - start_));
      ::posix_fadvise(fd, 0, 0, POSIX_FADV_SEQUENTIAL);  // only advice: no result is an error
    }
  }

  std::size_t read(std::span<std::byte> buffer) override {
    std::size_t done = 0;
    while (done < buffer.size()) {
      const std::size_t wanted = std::min(buffer.size() - done, kLargestTransfer);
      const ssize_t got = ::read(file_.get(), buffer.data() + done, wanted);
      if (got == 0) break;
      if (got > 0) {
        done += static_cast<std::size_t>(got);
      } else if (errno != EINTR) {
        fail(errno);
      }
    }
    return done;
  }

  bool seek(std::uint64_t position) override {
    if (!size_) return false;
    if (::lseek(file_.get(), start_ + static_cast<off_t>(position), SEEK_SET) < 0) fail(errno);
    return true;
  }

  [[nodiscard]] std::optional<std::uint64_t> size() const override { return size_; }
  [[nodiscard]] const std::string& name() const override { return name_; }

 private:
  [[noreturn]] void fail(int error) const {
    throw Error(fmt::format("cannot read {}: {}", name_, reason(error)));
  }

  Descriptor file_;
  std::string name_;
  off_t start_ = 0;  // where reading began
  std::optional<std::uint64_t> size_;
};

/// A file being written through one buffer. `temporary` is empty for what has no temporary name.
class DiskOutput : public OutputFile {
 public:
  DiskOutput(int fd, std::string name, std::string final_path, std::string temporary)
      : file_(fd),
        name_(std::move(name)),
        final_path_(std::move(final_path)),
        temporary_(std::move(temporary)) {
    buffer_.reserve(kOutputBuffer);
  }

  ~DiskOutput() override {
    if (committed_ || temporary_.empty()) return;
    UnfinishedFiles& unfinished = unfinished_files();
    const std::lock_guard lock(unfinished.mutex);
    ::unlink(temporary_.c_str());
    unfinished.paths.erase(temporary_);
  }

  DiskOutput(const DiskOutput&) = delete;
  DiskOutput& operator=(const DiskOutput&) = delete;

  void write(std::span<const std::byte> bytes) override {
    if (buffer_.size() + bytes.size() > kOutputBuffer) flush();
    if (bytes.size() >= kOutputBuffer) {
      append(bytes);
    } else {
      buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
    }
  }

  bool rewrite(std::uint64_t offset, std::span<const std::byte> bytes) override {
    if (temporary_.empty()) return false;
    flush();
    while (!bytes.empty()) {
      const ssize_t put =
          ::pwrite(file_.get(), bytes.data(), bytes.size(), static_cast<off_t>(offset));
      if (put >= 0) {
        bytes = bytes.subspan(static_cast<std::size_t>(put));
        offset += static_cast<std::uint64_t>(put);
      } else if (errno != EINTR) {
        fail(errno);
      }
    }
    return true;
  }

  void commit() override {
    flush();
    if (const int error = file_.close()) fail(error);
    if (!temporary_.empty()) {
      UnfinishedFiles& unfinished = unfinished_files();
      const std::lock_guard lock(unfinished.mutex);
      if (::rename(temporary_.c_str(), final_path_.c_str()) != 0) fail(errno);
      unfinished.paths.erase(temporary_);
    }
    committed_ = true;
  }

  [[nodiscard]] const std::string& name() const override { return name_; }
  [[nodiscard]] std::string temporary_path() const override { return temporary_; }

 private:
  void flush() {
    append(buffer_);
    buffer_.clear();
  }

  void append(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
      const std::size_t wanted = std::min(bytes.size(), kLargestTransfer);
      const ssize_t put = ::write(file_.get(), bytes.data(), wanted);
      if (put >= 0) {
        bytes = bytes.subspan(static_cast<std::size_t>(put));
      } else if (errno != EINTR) {
        fail(errno);
      }
    }
  }

  [[noreturn]] void fail(int error) const {
    if (error == EPIPE) throw ClosedPipe();
    throw Error(
        fmt::format("cannot write {}: {}{}", name_, reason(error), output_hint(error, name_)));
  }

  Descriptor file_;
  std::string name_;
  std::string final_path_;
  std::string temporary_;
  std::vector<std::byte> buffer_;
  bool committed_ = false;
};

[[noreturn]] void fail_to_create(const std::string& path, int error, const std::string& hint) {
  throw Error(fmt::format("cannot create {}: {}{}", path, reason(error), hint));
}

class Disk : public FileSystem {
 public:
  std::unique_ptr<InputFile> open(const std::string& path) override {
    const bool standard = path == "-";
    const int fd = standard ? ::fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 0)
                            : ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    const std::string name = standard ? "standard input" : path;
    if (fd < 0) {
      const int error = errno;
      throw Error(fmt::format("cannot open {}: {}{}", name, reason(error),
                              error == ENOENT ? "; check the name" : ""));
    }
    return std::make_unique<DiskInput>(fd, name);
  }

  std::unique_ptr<OutputFile> create(const std::string& path) override {
    if (path == "-") {
      const int fd = ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0);
      if (fd < 0) fail_to_create("standard output", errno, "");
      return std::make_unique<DiskOutput>(fd, "standard output", "", "");
    }
    if (path.empty()) throw UsageError("cannot create a file without a name; name the output");
    struct stat status {};
    const bool present = ::stat(path.c_str(), &status) == 0;
    if (present && S_ISDIR(status.st_mode)) {
      fail_to_create(path, EISDIR, "; name a file in it");
    }
    if (present && !S_ISREG(status.st_mode)) {
      const int fd = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
      if (fd < 0) fail_to_create(path, errno, "");
      return std::make_unique<DiskOutput>(fd, path, path, "");
    }
    if (present && ::access(path.c_str(), W_OK) != 0) {
      fail_to_create(path, errno, "; the file is there and write-protected, choose another name");
    }
    return create_temporary(path, present);
  }

  [[nodiscard]] bool exists(const std::string& path) const override {
    struct stat status {};
    return ::stat(path.c_str(), &status) == 0;
  }

 private:
  static std::unique_ptr<OutputFile> create_temporary(const std::string& path, bool present) {
    std::error_code unresolved;
    std::string final_path = path;
    if (present) final_path = std::filesystem::canonical(path, unresolved).string();
    if (unresolved) final_path = path;
    const std::string temporary = final_path + ".part";
    UnfinishedFiles& unfinished = unfinished_files();
    const std::lock_guard lock(unfinished.mutex);
    const int fd = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (fd < 0) {
      const int error = errno;
      fail_to_create(path, error, output_hint(error, path));
    }
    unfinished.paths.insert(temporary);
    return std::make_unique<DiskOutput>(fd, path, final_path, temporary);
  }
};

}  // namespace

FileSystem& disk() {
  static Disk instance;
  return instance;
}

OthersUnfinishedFile::OthersUnfinishedFile(std::string path) : path_(std::move(path)) {
  UnfinishedFiles& unfinished = unfinished_files();
  const std::lock_guard lock(unfinished.mutex);
  unfinished.paths.insert(path_);
}

OthersUnfinishedFile::~OthersUnfinishedFile() {
  UnfinishedFiles& unfinished = unfinished_files();
  const std::lock_guard lock(unfinished.mutex);
  unfinished.paths.erase(path_);
}

std::string make_temporary_folder(const std::string& parent, const std::string& prefix) {
  std::string path = (std::filesystem::path(parent) / (prefix + "XXXXXX")).string();
  UnfinishedFiles& unfinished = unfinished_files();
  const std::lock_guard lock(unfinished.mutex);
  if (::mkdtemp(path.data()) == nullptr) {
    throw Error(fmt::format("cannot create a temporary folder in {}: {}", parent, reason(errno)));
  }
  unfinished.folders.insert(path);
  return path;
}

void create_in_temporary_folder(const std::string& folder, const std::string& name) {
  const std::string path = (std::filesystem::path(folder) / name).string();
  UnfinishedFiles& unfinished = unfinished_files();
  const std::lock_guard lock(unfinished.mutex);
  const int fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (fd < 0) fail_to_create(path, errno, "");
  ::close(fd);
}

bool is_temporary_folder(const std::string& folder) {
  UnfinishedFiles& unfinished = unfinished_files();
  const std::lock_guard lock(unfinished.mutex);
  return unfinished.folders.contains(folder);
}

void remove_temporary_folder(const std::string& folder) {
  UnfinishedFiles& unfinished = unfinished_files();
  const std::lock_guard lock(unfinished.mutex);
  std::error_code ignored;  // what cannot be removed is left to whoever cleans the parent
  if (unfinished.folders.erase(folder) > 0) std::filesystem::remove_all(folder, ignored);
}

void remove_unfinished_files() {
  UnfinishedFiles& unfinished = unfinished_files();
  const std::lock_guard lock(unfinished.mutex);
  for (const std::string& path : unfinished.paths) ::unlink(path.c_str());
  unfinished.paths.clear();
  std::error_code ignored;  // the next folder is to be tried all the same
  for (const std::string& path : unfinished.folders) std::filesystem::remove_all(path, ignored);
  unfinished.folders.clear();
}

}  // namespace spillway
