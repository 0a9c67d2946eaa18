#include "tools/batch/job_log.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <string_view>
#include <system_error>

#include "src/error.h"

namespace spillway::command {
namespace {

/// A line is not longer, or its end will do.
constexpr off_t kLongestLine = off_t{1} << 16;

/// Another run may put a file there at the same time.
constexpr int kMostAttempts = 100;

}  // namespace

JobLog::JobLog(const std::string& path) : descriptor_(-1) {
  for (int attempt = 0; descriptor_ < 0 && attempt < kMostAttempts; ++attempt) {
    ::unlink(path.c_str());  // what is not there need not go; what stays is told by open()
    descriptor_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0666);
    if (descriptor_ < 0 && errno != EEXIST) break;
  }
  if (descriptor_ < 0) {
    throw Failure(
        fmt::format("cannot create {}: {}", path, std::generic_category().message(errno)));
  }
}

JobLog::~JobLog() { ::close(descriptor_); }

std::string JobLog::last_line() const {
  const off_t size = ::lseek(descriptor_, 0, SEEK_END);
  std::string text(static_cast<std::size_t>(std::clamp(size, off_t{0}, kLongestLine)), '\0');
  const ssize_t got =
      ::pread(descriptor_, text.data(), text.size(), size - static_cast<off_t>(text.size()));
  text.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
  const std::size_t end = text.find_last_not_of('\n');
  if (end == std::string::npos) return "";
  text.resize(end + 1);
  const std::string_view last = std::string_view(text).substr(text.rfind('\n') + 1);
  constexpr std::string_view kPrefix = "spillway: error: ";
  return std::string(last.starts_with(kPrefix) ? last.substr(kPrefix.size()) : last);
}

}  // namespace spillway::command
