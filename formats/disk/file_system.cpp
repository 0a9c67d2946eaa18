#include "formats/disk/file_system.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <stdexcept>
#include <stop_token>
#include <system_error>
#include <utility>
#include <vector>

#include "formats/disk/output_target.h"
#include "formats/disk/private_file.h"
#include "formats/disk/unfinished_files.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

constexpr std::size_t kOutputBuffer = std::size_t{1} << 20;

// Linux transfers at most 2 GiB - 4 KiB in one call; smaller pieces keep errors close to the cause.
constexpr std::size_t kLargestTransfer = std::size_t{1} << 28;

// How soon a reader that waits for a pipe notices that it is to stop.
constexpr int kPatienceInMilliseconds = 50;

std::string reason(int error) { return std::generic_category().message(error); }

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

/// Waits until there is something to read, or no one is left who writes. Throws Interrupted.
void wait_for_writer(int fd, const std::stop_token& stop) {
  pollfd pipe{.fd = fd, .events = POLLIN, .revents = 0};
  int ready = 0;
  while (ready == 0 || (ready < 0 && errno == EINTR)) {
    if (stop.stop_requested()) throw Interrupted();
    ready = ::poll(&pipe, 1, kPatienceInMilliseconds);
  }
}

class DiskInput : public InputFile {
 public:
  DiskInput(int fd, std::string name, std::stop_token stop)
      : file_(fd), name_(std::move(name)), stop_(std::move(stop)) {
    struct stat status {};
    if (::fstat(fd, &status) != 0) fail(errno);
    if (S_ISDIR(status.st_mode)) {
      throw SystemRefusal(fmt::format("cannot read {}: it is a folder; name a file in it", name_),
                          name_, EISDIR);
    }
    if (S_ISREG(status.st_mode)) {
      // Standard input may have been read from before: what counts is the rest.
      start_ = std::max<off_t>(0, ::lseek(fd, 0, SEEK_CUR));
      size_ = static_cast<std::uint64_t>(std::max<off_t>(0, status.st_size - start_));
      ::posix_fadvise(fd, 0, 0, POSIX_FADV_SEQUENTIAL);  // only advice: no result is an error
    }
  }

  std::size_t read(std::span<std::byte> buffer) override {
    const std::size_t got =
        read_all(buffer, [this](std::span<std::byte> rest, std::size_t /*done*/) {
          if (!size_ && stop_.stop_possible()) wait_for_writer(file_.get(), stop_);
          return ::read(file_.get(), rest.data(), rest.size());
        });
    if (size_ && got < buffer.size()) {
      check_end(static_cast<std::uint64_t>(::lseek(file_.get(), 0, SEEK_CUR) - start_));
    }
    return got;
  }

  std::optional<std::size_t> read_at(std::uint64_t position,
                                     std::span<std::byte> buffer) const override {
    if (!size_) return std::nullopt;
    const std::size_t got = read_all(buffer, [&](std::span<std::byte> rest, std::size_t done) {
      return ::pread(file_.get(), rest.data(), rest.size(),
                     start_ + static_cast<off_t>(position + done));
    });
    if (got < buffer.size() && position <= *size_) check_end(position + got);
    return got;
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
    throw SystemRefusal(fmt::format("cannot read {}: {}", name_, reason(error)), name_, error);
  }

  /// Throws BadInput if the file ends at this byte, but ended elsewhere when it was opened: who has
  /// read it to there has not read what it was, nor what it becomes.
  void check_end(std::uint64_t end) const {
    struct stat status {};
    if (*size_ == 0 || end == *size_ || ::fstat(file_.get(), &status) != 0) return;
    const auto now = static_cast<std::uint64_t>(std::max<off_t>(0, status.st_size - start_));
    if (now == *size_) return;  // as of files that the system makes up
    throw BadInput(name_,
                   fmt::format("the file had {} bytes when it was opened, and now has {}: it was "
                               "changed while it was read; wait until it is complete",
                               *size_, now),
                   at_byte(end));
  }

  /// Fills the buffer by calls of read_some(rest, done), until the file ends.
  template <typename ReadSome>
  std::size_t read_all(std::span<std::byte> buffer, const ReadSome& read_some) const {
    std::size_t done = 0;
    while (done < buffer.size()) {
      const std::size_t wanted = std::min(buffer.size() - done, kLargestTransfer);
      const ssize_t got = read_some(buffer.subspan(done, wanted), done);
      if (got == 0) break;
      if (got > 0) {
        done += static_cast<std::size_t>(got);
      } else if (errno != EINTR) {
        fail(errno);
      }
    }
    return done;
  }

  Descriptor file_;
  std::string name_;
  std::stop_token stop_;
  off_t start_ = 0;  // where reading began
  std::optional<std::uint64_t> size_;
};

/// A file being written through one buffer. `temporary` is null for what has no temporary name;
/// `is_private` if that is a file in a private folder.
class DiskOutput : public OutputFile {
 public:
  DiskOutput(int fd, std::string name, std::unique_ptr<UnfinishedFile> temporary,
             bool is_private = false)
      : file_(fd),
        name_(std::move(name)),
        temporary_(std::move(temporary)),
        can_rewrite_(temporary_ != nullptr || is_private) {
    buffer_.reserve(kOutputBuffer);
  }

  void write(std::span<const std::byte> bytes) override {
    if (buffer_.size() + bytes.size() > kOutputBuffer) flush();
    if (bytes.size() >= kOutputBuffer) {
      append(bytes);
    } else {
      buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
    }
  }

  bool rewrite(std::uint64_t offset, std::span<const std::byte> bytes) override {
    if (!can_rewrite_) return false;
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

  std::uint64_t sync() override {
    flush();
    if (::fdatasync(file_.get()) != 0) fail(errno);
    const off_t end = ::lseek(file_.get(), 0, SEEK_CUR);
    if (end < 0) fail(errno);
    return static_cast<std::uint64_t>(end);
  }

  void go_on_after(std::uint64_t bytes) override {
    buffer_.clear();
    const off_t end = ::lseek(file_.get(), 0, SEEK_END);
    if (end < static_cast<off_t>(bytes)) {
      throw BadInput(FileSpot{temporary_path(), at_byte(static_cast<std::uint64_t>(end))},
                     fmt::format("the file ends, of which {} bytes were written: the run cannot go "
                                 "on",
                                 bytes));
    }
    if (::ftruncate(file_.get(), static_cast<off_t>(bytes)) != 0 ||
        ::lseek(file_.get(), static_cast<off_t>(bytes), SEEK_SET) < 0) {
      fail(errno);
    }
  }

  void commit() override {
    flush();
    const bool is_kept = temporary_ && temporary_->is_kept();
    if (is_kept && ::ftruncate(file_.get(), ::lseek(file_.get(), 0, SEEK_CUR)) != 0) fail(errno);
    if (is_kept && ::fdatasync(file_.get()) != 0) fail(errno);
    if (const int error = file_.close()) fail(error);
    if (!temporary_) return;
    if (const int error = temporary_->rename()) fail(error);
  }

  [[nodiscard]] const std::string& name() const override { return name_; }
  [[nodiscard]] std::string temporary_path() const override {
    return temporary_ ? temporary_->path() : "";
  }

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
    throw SystemRefusal(
        fmt::format("cannot write {}: {}{}", name_, reason(error), output_hint(error, name_)),
        name_, error);
  }

  Descriptor file_;
  std::string name_;
  std::unique_ptr<UnfinishedFile> temporary_;
  bool can_rewrite_;
  std::vector<std::byte> buffer_;
};

/// A copy of standard input or output. Throws Failure that begins with `what` if it is closed, or
/// open for the wrong direction only, as what main puts in place of what is closed.
int copy_of_standard(int descriptor, int wrong_direction, const std::string& what) {
  const int flags = ::fcntl(descriptor, F_GETFL);
  if (flags < 0 || (flags & O_ACCMODE) == wrong_direction) {
    throw SystemRefusal(fmt::format("{}: it is closed; name a file, or connect a pipe", what), "-",
                        EBADF);
  }
  const int copy = ::fcntl(descriptor, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
  if (copy < 0) {
    const int error = errno;
    throw SystemRefusal(fmt::format("{}: {}", what, reason(error)), "-", error);
  }
  return copy;
}

std::unique_ptr<OutputFile> create_output(const OutputTarget& target, const std::string& path,
                                          std::unique_ptr<UnfinishedFile> temporary) {
  const int fd = temporary->create();
  if (fd < 0) fail_to_create(path, errno);
  // Failing that, as on file systems without permissions, it has those of a new file.
  if (target.mode) static_cast<void>(::fchmod(fd, *target.mode));
  return std::make_unique<DiskOutput>(fd, path, std::move(temporary));
}

class Disk : public FileSystem {
 public:
  explicit Disk(std::stop_token stop = {}) : stop_(std::move(stop)) {}

  std::unique_ptr<InputFile> open(const std::string& path) override {
    if (path == "-") {
      const int fd = copy_of_standard(STDIN_FILENO, O_WRONLY, "cannot read standard input");
      return std::make_unique<DiskInput>(fd, "standard input", stop_);
    }
    // To open a named pipe waits for a writer, which cannot be stopped: the first read waits then.
    const int at_once = stop_.stop_possible() ? O_NONBLOCK : 0;
    const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | at_once);
    if (fd < 0) {
      const int error = errno;
      throw SystemRefusal(fmt::format("cannot open {}: {}{}", path, reason(error),
                                      error == ENOENT ? "; check the name" : ""),
                          path, error);
    }
    if (at_once != 0) static_cast<void>(::fcntl(fd, F_SETFL, O_RDONLY));
    return std::make_unique<DiskInput>(fd, path, stop_);
  }

  std::unique_ptr<OutputFile> create(const std::string& path) override {
    if (path == "-") {
      const int fd = copy_of_standard(STDOUT_FILENO, O_RDONLY, "cannot write standard output");
      return std::make_unique<DiskOutput>(fd, "standard output", nullptr);
    }
    const OutputTarget target = output_target(path);
    if (!target.regular) {
      const int fd = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
      if (fd < 0) fail_to_create(path, errno);
      return std::make_unique<DiskOutput>(fd, path, nullptr);
    }
    return create_output(target, path, std::make_unique<UnfinishedFile>(target.path, path));
  }

  [[nodiscard]] bool exists(const std::string& path) const override {
    struct stat status {};
    return ::stat(path.c_str(), &status) == 0;
  }

 private:
  std::stop_token stop_;
};

/// The disk, where outputs outlive the process.
class KeepingDisk final : public Disk {
 public:
  explicit KeepingDisk(std::string mark) : mark_(std::move(mark)) {}

  std::unique_ptr<OutputFile> create(const std::string& path) override {
    if (path != "-") {
      const OutputTarget target = output_target(path);
      if (target.regular) {
        return create_output(target, path,
                             std::make_unique<UnfinishedFile>(target.path, path, mark_));
      }
    }
    throw InvalidArgument(fmt::format("a run that can go on writes to a file, not to {}: name one",
                                      path == "-" ? "standard output" : path),
                          {.file = path});
  }

 private:
  const std::string mark_;
};

}  // namespace

std::uint64_t OutputFile::sync() {
  throw std::logic_error("this output cannot be brought to the disk: a fault of the program");
}

void OutputFile::go_on_after(std::uint64_t /*bytes*/) {
  throw std::logic_error("this output cannot be gone on with: a fault of the program");
}

std::unique_ptr<FileSystem> keep_outputs(std::string mark) {
  return std::make_unique<KeepingDisk>(std::move(mark));
}

std::unique_ptr<OutputFile> create_private_file(const std::string& path, const std::string& name) {
  const int fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW | O_CLOEXEC, 0666);
  if (fd < 0) fail_to_create(name, errno);
  return std::make_unique<DiskOutput>(fd, name, nullptr, true);
}

FileSystem& disk() {
  static Disk instance;
  return instance;
}

std::unique_ptr<FileSystem> disk_until(std::stop_token stop) {
  return std::make_unique<Disk>(std::move(stop));
}

}  // namespace spillway::formats
