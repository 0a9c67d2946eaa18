#include "formats/disk/scratch_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <new>
#include <string_view>
#include <system_error>
#include <unordered_map>
#include <utility>
#include <vector>

#include "formats/disk/unfinished_files.h"
#include "src/error.h"

namespace spillway::detail {
namespace {

/// What is now on the disk, and what was.
class Usage {
 public:
  explicit Usage(std::optional<std::uint64_t> cap) : cap_(cap) {}

  /// Counts bytes that are about to be written; false, and nothing counted, if they pass the cap.
  bool add(std::uint64_t bytes) {
    const std::lock_guard lock(mutex_);
    if (cap_ && (bytes > *cap_ || present_ > *cap_ - bytes)) return false;
    present_ += bytes;
    written_ += bytes;
    peak_ = std::max(peak_, present_);
    return true;
  }

  void remove(std::uint64_t bytes) {
    const std::lock_guard lock(mutex_);
    present_ -= bytes;
  }

  [[nodiscard]] std::uint64_t written() const {
    const std::lock_guard lock(mutex_);
    return written_;
  }
  [[nodiscard]] std::uint64_t peak() const {
    const std::lock_guard lock(mutex_);
    return peak_;
  }
  [[nodiscard]] std::optional<std::uint64_t> cap() const { return cap_; }

 private:
  const std::optional<std::uint64_t> cap_;
  mutable std::mutex mutex_;  // guards what follows
  std::uint64_t present_ = 0;
  std::uint64_t written_ = 0;
  std::uint64_t peak_ = 0;
};

/// Files that nobody needs any more, by label. Their bytes are gone, but not their length. Another
/// one goes on after that: a file system may look long for a new file's place where many have just
/// been removed. A file that has become long is not among them, as its length may be limited.
class SpareFiles {
 public:
  struct Spare {
    std::string path;
    std::uint64_t end = 0;
  };

  /// Returns false, and takes nothing, for one that is too long.
  bool put(const std::string& label, Spare spare) {
    if (spare.end > kMostLength) return false;
    const std::lock_guard lock(mutex_);
    spares_[label].push_back(std::move(spare));
    return true;
  }

  std::optional<Spare> take(const std::string& label) {
    const std::lock_guard lock(mutex_);
    std::vector<Spare>& spares = spares_[label];
    if (spares.empty()) return std::nullopt;
    Spare spare = std::move(spares.back());
    spares.pop_back();
    return spare;
  }

 private:
  static constexpr std::uint64_t kMostLength = std::uint64_t{64} << 20;

  std::mutex mutex_;
  std::unordered_map<std::string, std::vector<Spare>> spares_;  // guarded by mutex_
};

/// A file that is open for the duration of one operation: there may be more files than descriptors.
class Opened {
 public:
  Opened(const std::string& path, int flags) : fd_(::open(path.c_str(), flags | O_CLOEXEC)) {}
  ~Opened() {
    if (fd_ >= 0) ::close(fd_);
  }
  Opened(const Opened&) = delete;
  Opened& operator=(const Opened&) = delete;

  [[nodiscard]] int get() const { return fd_; }

 private:
  int fd_;
};

class DiskScratchFile : public ScratchFile {
 public:
  DiskScratchFile(std::string label, SpareFiles::Spare file, std::shared_ptr<Usage> usage,
                  std::shared_ptr<SpareFiles> spares)
      : label_(std::move(label)),
        path_(std::move(file.path)),
        begin_(file.end),
        usage_(std::move(usage)),
        spares_(std::move(spares)) {}
  ~DiskScratchFile() override {
    if (!serves_anew()) ::unlink(path_.c_str());  // gone already if the folder is
    usage_->remove(size_);
  }
  DiskScratchFile(const DiskScratchFile&) = delete;
  DiskScratchFile& operator=(const DiskScratchFile&) = delete;

  void append(std::span<const std::byte> bytes) override {
    if (!usage_->add(bytes.size())) {
      throw Error(fmt::format("cannot write {}: temporary files would take more than the {} bytes "
                              "allowed",
                              path_, usage_->cap().value_or(0)),
                  ErrorCode::kOutOfBudget, {.file = path_, .remedy = Remedy::kScratchLimit});
    }
    size_ += bytes.size();
    const Opened file(path_, O_WRONLY | O_APPEND);
    if (file.get() < 0) fail("write", errno);
    while (!bytes.empty()) {
      const ssize_t put = ::write(file.get(), bytes.data(), bytes.size());
      if (put >= 0) {
        bytes = bytes.subspan(static_cast<std::size_t>(put));
      } else if (errno != EINTR) {
        fail("write", errno);
      }
    }
  }

  void read(std::uint64_t offset, std::span<std::byte> buffer) const override {
    offset += begin_;
    const Opened file(path_, O_RDONLY);
    if (file.get() < 0) fail("read", errno);
    while (!buffer.empty()) {
      const ssize_t got =
          ::pread(file.get(), buffer.data(), buffer.size(), static_cast<off_t>(offset));
      if (got == 0) {
        throw Error(fmt::format("cannot read {}: it ends at byte {}, before what was written to "
                                "it; leave the folder alone while the program runs",
                                path_, offset),
                    ErrorCode::kBadInput, {.file = path_, .place = at_byte(offset)});
      }
      if (got > 0) {
        buffer = buffer.subspan(static_cast<std::size_t>(got));
        offset += static_cast<std::uint64_t>(got);
      } else if (errno != EINTR) {
        fail("read", errno);
      }
    }
  }

  [[nodiscard]] std::uint64_t size() const override { return size_; }
  [[nodiscard]] const std::string& name() const override { return path_; }

 private:
  /// Gives the room on the disk back and the file to others. False if that cannot be, as on a file
  /// system that gives back the room of whole files only.
  [[nodiscard]] bool serves_anew() const {
    const Opened file(path_, O_WRONLY);
    if (file.get() < 0) return false;
    const off_t end = ::lseek(file.get(), 0, SEEK_END);  // a write may have failed halfway
    const auto begin = static_cast<off_t>(begin_);
    if (end < begin) return false;
    if (end > begin && ::fallocate(file.get(), FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, begin,
                                   end - begin) != 0) {
      return false;
    }
    try {
      return spares_->put(label_, {path_, static_cast<std::uint64_t>(end)});
    } catch (const std::bad_alloc&) {
      return false;
    }
  }

  [[noreturn]] void fail(std::string_view action, int error) const {
    stop_if_run_is_ending();
    const std::string_view what_to_do = hint(error);
    throw SystemRefusal(fmt::format("cannot {} {}: {}{}", action, path_,
                                    std::generic_category().message(error), what_to_do),
                        path_, error, what_to_do.empty() ? Remedy::kScratchFolder : Remedy::kNone);
  }

  /// What to do where another folder would not help.
  [[nodiscard]] static std::string_view hint(int error) {
    switch (error) {
      case EMFILE:
      case ENFILE:
        return "; raise the limit of open files (ulimit -n)";
      case ENOENT:
        return "; leave the folder alone while the program runs";
      default:
        return "";
    }
  }

  std::string label_;
  std::string path_;
  std::uint64_t begin_;  ///< where its own bytes begin
  std::shared_ptr<Usage> usage_;
  std::shared_ptr<SpareFiles> spares_;
  std::uint64_t size_ = 0;
};

class DiskScratchFolder : public ScratchFolder {
 public:
  DiskScratchFolder(std::string parent, std::optional<std::uint64_t> cap)
      : parent_(std::move(parent)), usage_(std::make_shared<Usage>(cap)) {}
  ~DiskScratchFolder() override {
    if (!path_.empty()) remove_temporary_folder(path_);
  }
  DiskScratchFolder(const DiskScratchFolder&) = delete;
  DiskScratchFolder& operator=(const DiskScratchFolder&) = delete;

  std::unique_ptr<ScratchFile> create(const std::string& label) override {
    const std::lock_guard lock(mutex_);
    try {
      if (path_.empty()) path_ = make_temporary_folder(parent_, "spillway-");
      std::optional<SpareFiles::Spare> file = spares_->take(label);
      if (!file) {
        const std::string name = fmt::format("{}-{}", label, ++files_);
        create_in_temporary_folder(path_, name);
        file = {(std::filesystem::path(path_) / name).string()};
      }
      return std::make_unique<DiskScratchFile>(label, std::move(*file), usage_, spares_);
    } catch (const Error& error) {
      // That a folder cannot be made has one remedy, whatever the system's reason.
      throw SystemRefusal(error.what(), error.facts().file, error.facts().system_error,
                          Remedy::kScratchFolder);
    }
  }

  [[nodiscard]] std::uint64_t bytes_written() const override { return usage_->written(); }
  [[nodiscard]] std::uint64_t peak_bytes() const override { return usage_->peak(); }

 private:
  const std::string parent_;
  const std::shared_ptr<Usage> usage_;
  const std::shared_ptr<SpareFiles> spares_ = std::make_shared<SpareFiles>();
  std::mutex mutex_;         // guards what follows
  std::string path_;         // empty until the first file is made
  std::uint64_t files_ = 0;  // made so far
};

}  // namespace

std::string scratch_parent(const std::string& parent) {
  if (!parent.empty()) return parent;
  const char* const temporary = std::getenv("TMPDIR");
  return temporary != nullptr && *temporary != '\0' ? temporary : "/tmp";
}

std::unique_ptr<ScratchFolder> make_scratch_folder(const std::string& parent,
                                                   std::optional<std::uint64_t> cap) {
  return std::make_unique<DiskScratchFolder>(scratch_parent(parent), cap);
}

}  // namespace spillway::detail
