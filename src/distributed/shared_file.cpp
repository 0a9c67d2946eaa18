#include "src/distributed/shared_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "src/error.h"

namespace spillway::distributed {
namespace {

[[noreturn]] void fail(const char* activity, const std::string& where, const std::string& file,
                       int error) {
  throw SystemRefusal(
      fmt::format("cannot {} {}: {}", activity, where, std::generic_category().message(error)),
      file, error);
}

/// Collective: `step` returns false if the system refuses it, which then throws at all ranks.
template <class Step>
void together(const Ranks& ranks, const char* activity, const std::string& name, const Step& step) {
  std::uint64_t error = step() ? 0 : static_cast<std::uint64_t>(errno);
  ranks.reduce(std::span(&error, 1), Reduction::kMost);
  if (error != 0) fail(activity, name, name, static_cast<int>(error));
}

}  // namespace

SharedFile::SharedFile(const Ranks& ranks, const std::string& path, const std::string& name)
    : ranks_(ranks), name_(name.empty() ? path : name) {
  const auto open = [&](int flags) {
    descriptor_ = ::open(path.c_str(), O_WRONLY | O_NOFOLLOW | O_CLOEXEC | flags, 0666);
    return descriptor_ >= 0;
  };
  together(ranks_, "create", name_, [&] { return ranks_.rank() != 0 || open(O_CREAT | O_TRUNC); });
  together(ranks_, "open", name_, [&] { return ranks_.rank() == 0 || open(0); });
}

SharedFile::~SharedFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void SharedFile::write(std::uint64_t offset, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written =
        ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      fail("write", fmt::format("{}, byte {}", name_, offset), name_, written < 0 ? errno : ENOSPC);
    }
    offset += static_cast<std::uint64_t>(written);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

void SharedFile::close() {
  together(ranks_, "close", name_, [&] { return ::close(std::exchange(descriptor_, -1)) == 0; });
}

}  // namespace spillway::distributed
