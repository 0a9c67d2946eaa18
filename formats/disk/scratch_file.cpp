#include "formats/disk/scratch_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <string_view>
#include <system_error>

#include "formats/disk/unfinished_files.h"
#include "src/error.h"

namespace spillway::formats {
namespace {

/// What to do where another folder would not help.
std::string_view hint(int error) {
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

}  // namespace

bool ScratchUsage::add(std::uint64_t bytes) {
  const std::lock_guard lock(mutex_);
  if (cap_ && (bytes > *cap_ || present_ > *cap_ - bytes)) return false;
  present_ += bytes;
  written_ += bytes;
  peak_ = std::max(peak_, present_);
  return true;
}

void ScratchUsage::remove(std::uint64_t bytes) {
  const std::lock_guard lock(mutex_);
  present_ -= bytes;
}

std::uint64_t ScratchUsage::written() const {
  const std::lock_guard lock(mutex_);
  return written_;
}

std::uint64_t ScratchUsage::peak() const {
  const std::lock_guard lock(mutex_);
  return peak_;
}

OpenedFile::OpenedFile(const std::string& path, int flags)
    : fd_(::open(path.c_str(), flags | O_CLOEXEC | ((flags & O_DIRECTORY) == 0 ? O_NOFOLLOW : 0))) {
}

OpenedFile::~OpenedFile() {
  if (fd_ >= 0) ::close(fd_);
}

void DiskScratchFile::append(std::span<const std::byte> bytes) {
  if (!usage_.add(bytes.size())) {
    throw Failure(fmt::format("cannot write {}: temporary files would take more than the {} bytes "
                              "allowed",
                              path_, usage_.cap().value_or(0)),
                  ErrorCode::kOutOfBudget, {.file = path_, .remedy = Remedy::kScratchLimit});
  }
  size_ += bytes.size();
  const OpenedFile file(path_, O_WRONLY | O_APPEND);
  if (file.get() < 0) fail_at_scratch_file("write", path_, errno);
  while (!bytes.empty()) {
    const ssize_t put = ::write(file.get(), bytes.data(), bytes.size());
    if (put >= 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(put));
    } else if (errno != EINTR) {
      fail_at_scratch_file("write", path_, errno);
    }
  }
}

void DiskScratchFile::read(std::uint64_t offset, std::span<std::byte> buffer) const {
  offset += begin_;
  const OpenedFile file(path_, O_RDONLY);
  if (file.get() < 0) fail_at_scratch_file("read", path_, errno);
  while (!buffer.empty()) {
    const ssize_t got =
        ::pread(file.get(), buffer.data(), buffer.size(), static_cast<off_t>(offset));
    if (got == 0) {
      throw Failure(fmt::format("cannot read {}: it ends at byte {}, before what was written to "
                                "it; leave the folder alone while the program runs",
                                path_, offset),
                    ErrorCode::kBadInput, {.file = path_, .place = at_byte(offset)});
    }
    if (got > 0) {
      buffer = buffer.subspan(static_cast<std::size_t>(got));
      offset += static_cast<std::uint64_t>(got);
    } else if (errno != EINTR) {
      fail_at_scratch_file("read", path_, errno);
    }
  }
}

void fail_at_scratch_file(const char* action, const std::string& path, int error) {
  stop_if_run_is_ending();
  const std::string_view what_to_do = hint(error);
  throw SystemRefusal(fmt::format("cannot {} {}: {}{}", action, path,
                                  std::generic_category().message(error), what_to_do),
                      path, error, what_to_do.empty() ? Remedy::kScratchFolder : Remedy::kNone);
}

}  // namespace spillway::formats
